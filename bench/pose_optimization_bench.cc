// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates the pose of one frame from synthetic observations, which have a noise of 1 px. One in
// ten is an outlier. The start is as far from the true pose as the prediction of a motion model.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "camera/point_measurement.h"
#include "optim/joint_pose_optimization.h"
#include "optim/pose_optimization.h"

namespace hullslam {
namespace {

constexpr PinholeCamera kCamera{.fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};

std::vector<PoseObservation> MakeObservations(size_t count) {
  std::mt19937 random(1);
  const auto number = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::normal_distribution<double> noise;
  std::vector<PoseObservation> observations(count);
  for (size_t i = 0; i < count; ++i) {
    PoseObservation& observation = observations[i];
    observation.point = {number(-1.0, 1.0), number(-0.8, 0.8), number(2.0, 5.0)};
    Eigen::Vector3d measured = ProjectRgbd(kCamera, observation.point) +
                               Eigen::Vector3d(noise(random), noise(random), noise(random));
    if (i % 10 == 0) {
      measured.x() += number(10.0, 60.0);
    }
    observation.measurement = PointMeasurement::Create(
        measured.head<2>(), 1.0, i % 4 != 0 ? std::optional(measured.z()) : std::nullopt, {});
  }
  return observations;
}

void PoseOptimization(benchmark::State& state) {
  const auto observations = MakeObservations(static_cast<size_t>(state.range(0)));
  const Rigid3 start(ExpSo3({0.01, -0.02, 0.01}), {0.02, 0.01, -0.02});
  int inliers = 0;
  for (auto _ : state) {
    inliers = OptimizePose(kCamera, start, observations).inlier_count;
  }
  state.counters["inliers"] = inliers;
}
BENCHMARK(PoseOptimization)
    ->ArgName("points")
    ->Arg(50)
    ->Arg(300)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);

// The same with eight objects of 16 lines each.
void JointPoseOptimization(benchmark::State& state) {
  const auto observations = MakeObservations(static_cast<size_t>(state.range(0)));
  const Detection detection;
  std::vector<PoseObject> objects(8);
  for (size_t i = 0; i < objects.size(); ++i) {
    const double x = static_cast<double>(i % 4) - 1.5;
    objects[i].ellipsoid = {{Eigen::Quaterniond::Identity(), {0.6 * x, i < 4 ? -0.4 : 0.4, 3.0}},
                            {0.2, 0.15, 0.1}};
    const Ellipse ellipse =
        ProjectEllipsoid(kCamera.Matrix(), Rigid3(), objects[i].ellipsoid).value();
    for (int k = 0; k < 16; ++k) {
      const double angle = k * std::numbers::pi / 8.0;
      const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
      objects[i].lines.push_back(
          {{normal, -normal.dot(ellipse.center) - ellipse.HalfExtent(normal)}, false});
    }
    objects[i].detection = &detection;
    objects[i].misfit_px = 4.0;
  }
  const Rigid3 start(ExpSo3({0.01, -0.02, 0.01}), {0.02, 0.01, -0.02});
  int used = 0;
  for (auto _ : state) {
    used = OptimizeJointPose(kCamera, start, observations, objects).used_objects;
  }
  state.counters["objects"] = used;
}
BENCHMARK(JointPoseOptimization)
    ->ArgName("points")
    ->Arg(0)
    ->Arg(50)
    ->Arg(300)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hullslam

BENCHMARK_MAIN();

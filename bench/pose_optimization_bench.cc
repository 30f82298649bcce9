// SPDX-License-Identifier: GPL-3.0-or-later
// The pose of one frame from made-up observations: noise of 1 px, a tenth of them wrong, the start
// as far off as a motion model is.
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "hullslam/costs/projection.h"
#include "hullslam/map/intrinsics.h"
#include "hullslam/optim/pose_optimization.h"

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
    observation.measured = ProjectRgbd(ToIntrinsics(kCamera), observation.point) +
                           Eigen::Vector3d(noise(random), noise(random), noise(random));
    observation.has_depth = i % 4 != 0;
    if (i % 10 == 0) {
      observation.measured.x() += number(10.0, 60.0);
    }
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

}  // namespace
}  // namespace hullslam

BENCHMARK_MAIN();

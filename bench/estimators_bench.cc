// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates the pose of a camera, and the similarity of two keyframes, from made-up matches with a
// noise of 0.7 px, of which a given share is wrong.
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "camera/point_measurement.h"
#include "estimators/absolute_pose.h"
#include "estimators/similarity.h"

namespace hullslam {
namespace {

constexpr PinholeCamera kCamera{.fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};

class RandomPoints {
 public:
  double Number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Eigen::Vector3d InFront() {
    const double x = Number(-1.2, 1.2);
    const double y = Number(-1.0, 1.0);
    return {x, y, Number(2.0, 6.0)};
  }
  PointMeasurement Measure(const Eigen::Vector3d& point) {
    std::normal_distribution<double> noise(0.0, 0.7);
    Eigen::Vector2d pixel = kCamera.Project(point);
    pixel.x() += noise(random_);
    pixel.y() += noise(random_);
    return PointMeasurement::Create(pixel, 1.0, std::nullopt, {});
  }

 private:
  std::mt19937 random_{1};
};

void AbsolutePoseEstimation(benchmark::State& state) {
  RandomPoints random;
  const Rigid3 cam_from_world(ExpSo3({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0});
  const auto count = static_cast<size_t>(state.range(0));
  const size_t outliers = count * static_cast<size_t>(state.range(1)) / 100;
  std::vector<PoseObservation> matches;
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d in_cam = random.InFront();
    matches.push_back({Inverse(cam_from_world) * in_cam,
                       random.Measure(i < outliers ? random.InFront() : in_cam)});
  }
  RansacOptions options;
  double iterations = 0.0;
  double inliers = 0.0;
  for (auto _ : state) {
    ++options.seed;
    const AbsolutePose result = EstimateAbsolutePose(kCamera, matches, options);
    iterations += result.iterations;
    inliers += static_cast<double>(result.inliers.size());
  }
  state.counters["iterations"] = iterations / static_cast<double>(state.iterations());
  state.counters["inliers"] = inliers / static_cast<double>(state.iterations());
}
BENCHMARK(AbsolutePoseEstimation)
    ->ArgNames({"matches", "outliers_percent"})
    ->ArgsProduct({{30, 100, 500}, {20, 50, 70, 100}})
    ->Unit(benchmark::kMillisecond);

void SimilarityEstimation(benchmark::State& state) {
  RandomPoints random;
  const Sim3 b_from_a(1.2, ExpSo3({0.1, 0.05, 0.1}), {0.2, 0.1, 0.1});
  const auto count = static_cast<size_t>(state.range(0));
  const size_t outliers = count * static_cast<size_t>(state.range(1)) / 100;
  std::vector<SimilarityMatch> matches(count);
  for (size_t i = 0; i < count; ++i) {
    SimilarityMatch& match = matches[i];
    match.point_in_a = random.InFront();
    match.point_in_b = i < outliers ? random.InFront() : b_from_a * match.point_in_a;
    match.measured_in_a = random.Measure(match.point_in_a);
    match.measured_in_b = random.Measure(match.point_in_b);
  }
  SimilarityOptions options;
  double iterations = 0.0;
  double inliers = 0.0;
  for (auto _ : state) {
    ++options.ransac.seed;
    const Similarity result = EstimateSimilarity(kCamera, matches, options);
    iterations += result.iterations;
    inliers += static_cast<double>(result.inliers.size());
  }
  state.counters["iterations"] = iterations / static_cast<double>(state.iterations());
  state.counters["inliers"] = inliers / static_cast<double>(state.iterations());
}
BENCHMARK(SimilarityEstimation)
    ->ArgNames({"matches", "outliers_percent"})
    ->ArgsProduct({{30, 100}, {20, 50, 70, 100}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hullslam

BENCHMARK_MAIN();

// SPDX-License-Identifier: GPL-3.0-or-later
// Turns the masks of one frame into detections (hulls, lines, depth points), for each primitive.
// There are ten masks with 170 outline points each.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "frame/detection/detection_builder.h"

namespace hullslam {
namespace {

PinholeCamera BenchCamera() {
  PinholeCamera camera;
  camera.fx = camera.fy = 517.0;
  camera.cx = 318.6;
  camera.cy = 255.3;
  camera.k1 = 0.262383;
  camera.k2 = -0.953104;
  camera.p1 = -0.005358;
  camera.p2 = 0.002628;
  camera.k3 = 1.163314;
  return camera;
}

// Ellipses with ragged outlines, as a network gives them, on a grid of 5 x 2.
std::vector<InstanceMask> BenchMasks() {
  std::vector<InstanceMask> masks;
  for (int i = 0; i < 10; ++i) {
    InstanceMask mask{.label = "thing" + std::to_string(i), .score = 0.5, .outlines = {{}}};
    const int row = i / 5;
    const Eigen::Vector2d center(70.0 + 125.0 * (i % 5), 130.0 + 220.0 * row);
    for (int k = 0; k < 170; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / 170.0;
      const double ragged = 1.0 + 0.04 * std::sin(23.0 * angle) + 0.1 * std::sin(3.0 * angle);
      mask.outlines[0].emplace_back(center.x() + std::round(55.0 * ragged * std::cos(angle)),
                                    center.y() + std::round(90.0 * ragged * std::sin(angle)));
    }
    masks.push_back(mask);
  }
  return masks;
}

void Build(benchmark::State& state) {
  DetectionOptions options;
  options.primitive = static_cast<ObjectPrimitive>(state.range(0));
  const DetectionBuilder builder(BenchCamera(), 5000.0, options);
  const std::vector<InstanceMask> masks = BenchMasks();
  const cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(7500));
  std::vector<RawKeypoint> keypoints(1000);
  for (size_t i = 0; i < keypoints.size(); ++i) {
    keypoints[i].raw = {static_cast<float>(i % 640), static_cast<float>(i * 37 % 480)};
  }
  DetectionResult result;
  for (auto _ : state) {
    result = builder.Build(masks, state.range(1) != 0 ? depth : cv::Mat(), keypoints);
  }
  state.SetLabel(std::string(NameOf(options.primitive)));
  state.counters["detections"] = static_cast<double>(result.detections.size());
}
BENCHMARK(Build)
    ->ArgNames({"primitive", "depth"})
    ->ArgsProduct({{0, 1, 2, 3, 4}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hullslam

BENCHMARK_MAIN();

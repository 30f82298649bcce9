// SPDX-License-Identifier: GPL-3.0-or-later
// The three kinds of matching, on two frames with 1000 random keypoints each.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "geometry/triangulation.h"
#include "matching/by_descriptor.h"
#include "matching/by_projection.h"
#include "matching/for_triangulation.h"

namespace hullslam {
namespace {

constexpr size_t kKeypoints = 1000;

// Frame b has the keypoints of frame a, 10 px further to the left and with 20 bits of each
// descriptor flipped. An equal shift means that all points have the same depth, which does not
// matter for the time.
struct Frames {
  FrameFeatures a;
  FrameFeatures b;
  ScaleLevels levels = ScaleLevels::Create(8, 1.2);
  std::vector<uint32_t> all = std::vector<uint32_t>(kKeypoints);
};

FrameFeatures Moved(const FrameFeatures& features, std::mt19937_64& random) {
  FrameFeatures moved = features;
  for (size_t i = 0; i < moved.size(); ++i) {
    moved.keypoints[i].undistorted.x() -= 10.0f;
    for (int flip = 0; flip < 20; ++flip) {
      const uint64_t bit = random() % 256;
      moved.descriptors[i][bit / 64] ^= uint64_t{1} << (bit % 64);
    }
  }
  return moved;
}

Frames MakeFrames() {
  Frames frames;
  std::mt19937_64 random(1);
  const auto number = [&random](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  for (size_t i = 0; i < kKeypoints; ++i) {
    Keypoint& keypoint = frames.a.keypoints.emplace_back();
    keypoint.undistorted = {number(30.0f, 620.0f), number(20.0f, 460.0f)};
    keypoint.angle = number(0.0f, 6.28f);
    keypoint.level = static_cast<int>(random() % 8);
    frames.a.descriptors.push_back({random(), random(), random(), random()});
  }
  frames.a.depth.assign(kKeypoints, 0.0f);
  frames.b = Moved(frames.a, random);
  for (FrameFeatures* features : {&frames.a, &frames.b}) {
    features->grid = FeatureGrid(features->keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  }
  std::iota(frames.all.begin(), frames.all.end(), 0);
  return frames;
}

void ByProjection(benchmark::State& state) {
  const Frames frames = MakeFrames();
  std::vector<Projection> projections;
  for (size_t i = 0; i < kKeypoints; ++i) {
    const Keypoint& keypoint = frames.a.keypoints[i];
    Projection& projection = projections.emplace_back();
    projection.pixel = keypoint.undistorted - Eigen::Vector2f(10.0f, 0.0f);
    projection.radius = static_cast<float>(state.range(0)) *
                        frames.levels.scale[static_cast<size_t>(keypoint.level)];
    projection.min_level = keypoint.level - 1;
    projection.max_level = keypoint.level + 1;
    projection.descriptor = frames.a.descriptors[i];
    projection.angle = keypoint.angle;
  }
  size_t found = 0;
  for (auto _ : state) {
    found = MatchByProjection(frames.b, projections, {}, {.compare_rotation = true}).size();
  }
  state.counters["matches"] = static_cast<double>(found);
}
BENCHMARK(ByProjection)->ArgName("radius_px")->Arg(4)->Arg(15)->Unit(benchmark::kMillisecond);

void ByDescriptor(benchmark::State& state) {
  const Frames frames = MakeFrames();
  size_t found = 0;
  for (auto _ : state) {
    found = MatchByDescriptor(frames.a, frames.all, frames.b, {}).size();
  }
  state.counters["matches"] = static_cast<double>(found);
}
BENCHMARK(ByDescriptor)->Unit(benchmark::kMillisecond);

void ForTriangulation(benchmark::State& state) {
  const Frames frames = MakeFrames();
  const Eigen::Matrix3d fundamental =
      EssentialFromPose({Eigen::Quaterniond::Identity(), {-1.0, 0.0, 0.0}});
  size_t found = 0;
  for (auto _ : state) {
    found = MatchForTriangulation(frames.a, frames.all, frames.b, frames.all, fundamental,
                                  {1e6, 1e6}, frames.levels, {})
                .size();
  }
  state.counters["matches"] = static_cast<double>(found);
}
BENCHMARK(ForTriangulation)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hullslam

BENCHMARK_MAIN();

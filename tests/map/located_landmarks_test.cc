// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/located_landmarks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

constexpr double kBaseline = 0.2;

// One keypoint of level 0. `depth` is 0 if it is not known.
std::shared_ptr<Frame> FrameWithKeypoint(uint32_t id, const Eigen::Vector2d& pixel, double depth) {
  auto frame = std::make_shared<Frame>();
  frame->id = FrameId(id);
  frame->features.keypoints.emplace_back().undistorted = pixel.cast<float>();
  frame->features.descriptors.emplace_back();
  frame->features.depth = {static_cast<float>(depth)};
  return frame;
}

// Whether the distance of a point is known that cameras see which are `baseline` apart. Beyond them
// the point is at `distance`, perpendicular to the baseline.
bool IsKnown(double distance, double baseline, bool has_depth = false) {
  const Sensor sensor = SyntheticSensor();
  const Eigen::Vector3d point(0.0, 0.0, distance);
  Map map;
  for (const uint32_t id : {0U, 1U}) {
    const double x = (id - 0.5) * baseline;
    const Rigid3 cam_from_world(Eigen::Quaterniond::Identity(), {-x, 0.0, 0.0});
    const Eigen::Vector2d pixel = sensor.camera.Project(cam_from_world * point);
    map.AddKeyframe(FrameWithKeypoint(id, pixel, has_depth ? distance : 0.0), cam_from_world);
  }
  const LandmarkId landmark = map.AddLandmark(point, KeyframeId(0));
  map.AddObservation(landmark, KeyframeId(0), 0);
  map.AddObservation(landmark, KeyframeId(1), 0);
  const LocatedLandmarks located = LocateLandmarks(map, sensor);
  EXPECT_EQ(located.positions.size() + located.at_infinity, 1u);
  return located.at_infinity == 0;
}

TEST(LocateLandmarks, FindsThePointsOfARoom) {
  const SyntheticWorld world;
  const SyntheticMap made = MakeSyntheticMap(world, {0, 10, 20});
  const LocatedLandmarks located = LocateLandmarks(made.map, world.sensor());
  EXPECT_EQ(located.at_infinity, 0u);
  EXPECT_EQ(located.positions.size(), made.map.landmarks().size());
  EXPECT_EQ(located.ids.size(), located.positions.size());
  EXPECT_EQ(located.ids[0], (*made.map.landmarks().begin()).first);
  EXPECT_EQ(located.positions[0], (*made.map.landmarks().begin()).second.position);
}

// Two keypoints with the standard deviation s have a disparity with that of sqrt(2) s, which is the
// disparity f b / d of a point at the distance f b / (sqrt(2) s). At half of this distance the
// disparity is two standard deviations.
TEST(LocateLandmarks, TheParallaxDecides) {
  const Sensor sensor = SyntheticSensor();
  const double farthest =
      0.5 * sensor.camera.fx * kBaseline / (std::numbers::sqrt2 * sensor.depth_error.pixel_sigma);
  EXPECT_TRUE(IsKnown(0.98 * farthest, kBaseline));
  EXPECT_FALSE(IsKnown(1.02 * farthest, kBaseline));
  for (const double scale : {1e-3, 10.0, 1e4}) {
    EXPECT_TRUE(IsKnown(0.98 * farthest * scale, kBaseline * scale)) << "another unit of length";
    EXPECT_FALSE(IsKnown(1.02 * farthest * scale, kBaseline * scale));
  }
  for (const double far : {1e3, 1e5, 1e7, 1e9, 1e12}) {
    EXPECT_FALSE(IsKnown(far, kBaseline)) << far;
  }
}

TEST(LocateLandmarks, MeasuredDepthReplacesParallax) {
  EXPECT_FALSE(IsKnown(3.0, 1e-4));
  EXPECT_TRUE(IsKnown(3.0, 1e-4, true));
}

}  // namespace
}  // namespace hullslam

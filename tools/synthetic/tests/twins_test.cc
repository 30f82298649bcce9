// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/twins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <opencv2/core.hpp>
#include <string>

#include "synthetic/object_models.h"
#include "synthetic/renderer.h"
#include "synthetic/scenes.h"

namespace hullslam::synthetic {
namespace {

constexpr double kFrameTime = 1.0 / 30.0;  // seconds

// The time at which the camera has the same pose in the second room as at `time` in the first one.
double TwinTime(const WaypointPath& path, double time) {
  const Rigid3 twin = Shift(kTwinDistance, 0.0, 0.0) * path.WorldFromCam(time);
  double best = 0.0;
  double least = 10.0;
  for (double other = 0.5 * path.duration(); other < path.duration(); other += kFrameTime) {
    const Rigid3 motion = Inverse(twin) * path.WorldFromCam(other);
    const double difference = motion.translation.norm() + LogSo3(motion.rotation).norm();
    if (difference < least) {
      least = difference;
      best = other;
    }
  }
  EXPECT_LT(least, 0.15) << time;
  return best;
}

TEST(TwinsPath, LooksAroundInBothRoomsInTheSameWay) {
  const WaypointPath path = TwinsPath();
  EXPECT_LT(path.WorldFromCam(0.0).translation.x(), 0.0);
  EXPECT_GT(path.WorldFromCam(path.duration()).translation.x(), 0.0);
  double last = 0.0;
  for (double time = 0.0; time < 7.0; time += 0.5) {
    const double twin = TwinTime(path, time);
    EXPECT_GE(twin, last);
    last = twin;
  }
}

TEST(Twins, RoomsLookAlikeWithoutTheirObjectsAndDifferInThem) {
  Scene scene = BuildScene(SceneKind::kTwins, DefaultFrames(SceneKind::kTwins), 1);
  const PinholeCamera small = {
      .fx = 133.85, .fy = 134.8, .cx = 80.0, .cy = 61.9, .width = 160, .height = 120};
  const Rigid3 start = TwinsPath().WorldFromCam(0.0);
  // The camera jumps from the first room to the second.
  scene.world_from_cam = [&](double time) {
    return Shift(time > 0.5 ? kTwinDistance : 0.0, 0.0, 0.0) * start;
  };
  std::map<std::string, int> first;
  std::map<std::string, int> second;
  for (const SceneObject& object : scene.objects) {
    ++(object.world_from_object.translation.x() < 0.0 ? first : second)[object.class_name];
  }
  EXPECT_NE(first, second);
  const auto changed = [&] {
    const Renderer renderer(scene, small);
    const cv::Mat a = renderer.Render(0.0).depth;
    const cv::Mat b = renderer.Render(1.0).depth;
    const cv::Mat difference = cv::abs(a - b) > 0.01;
    return cv::countNonZero(difference) / static_cast<double>(a.total());
  };
  EXPECT_GT(changed(), 0.03);
  scene.objects.clear();
  EXPECT_LT(changed(), 1e-3);
  const Renderer renderer(scene, small);
  const cv::Mat a = renderer.Render(0.0).colour;
  const cv::Mat b = renderer.Render(1.0).colour;
  // The images differ a little, because the lamps of the other rooms are at other distances.
  EXPECT_LT(cv::norm(a, b, cv::NORM_L1) / (3.0 * static_cast<double>(a.total())), 16.0);
}

}  // namespace
}  // namespace hullslam::synthetic

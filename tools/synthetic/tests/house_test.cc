// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/house.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "synthetic/renderer.h"
#include "synthetic/scenes.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFrame = 1.0 / 30.0;  // seconds

// The distance of two poses (m) plus the angle between them (rad).
double UnlikenessOf(const Rigid3& a, const Rigid3& b) {
  return (a.translation - b.translation).norm() + AngularDistance(a.rotation, b.rotation);
}

TEST(HousePath, IsLongEnoughAtTheSpeedOfAPerson) {
  const WaypointPath path = HousePath();
  EXPECT_GE(path.duration(), 1200 * kFrame);
  double length = 0.0;
  for (double time = 0.0; time < path.duration(); time += kFrame) {
    const Vector3d here = path.WorldFromCam(time).translation;
    const double step = (path.WorldFromCam(time + kFrame).translation - here).norm();
    EXPECT_LT(step, 1.0 * kFrame) << time;
    EXPECT_LT(AngularDistance(path.WorldFromCam(time).rotation,
                              path.WorldFromCam(time + kFrame).rotation),
              1.1 * kFrame)
        << time;
    length += step;
  }
  EXPECT_GE(length, 20.0);
}

TEST(HousePath, VisitsFourRoomsAndTheCorridor) {
  const WaypointPath path = HousePath();
  std::vector<int> visits;
  for (double time = 0.0; time < path.duration(); time += kFrame) {
    const Vector2d at = path.WorldFromCam(time).translation.head<2>();
    const int room = std::abs(at.y()) < 0.75 ? 0 : (at.x() > 0.0 ? 1 : 2) * (at.y() > 0.0 ? 1 : -1);
    if (visits.empty() || visits.back() != room) {
      visits.push_back(room);
    }
  }
  EXPECT_EQ(visits, (std::vector<int>{2, 0, 1, 0, -1, -2, 0, 2}));
}

TEST(HousePath, SeesTheStartAgainForFortyFrames) {
  const WaypointPath path = HousePath();
  int similar = 0;
  for (double time = path.duration() - 3.0; time <= path.duration(); time += kFrame) {
    double nearest = 10.0;
    for (double start = 0.0; start < 3.0; start += kFrame) {
      nearest = std::min(nearest, UnlikenessOf(path.WorldFromCam(start), path.WorldFromCam(time)));
    }
    similar += nearest < 0.1 ? 1 : 0;
  }
  EXPECT_GE(similar, 40);
}

TEST(HousePath, LooksAlongTheCorridorTwice) {
  const WaypointPath path = HousePath();
  double nearest = 10.0;
  for (double first = 5.0; first < 15.0; first += kFrame) {
    for (double second = 45.0; second < path.duration() - 5.0; second += kFrame) {
      nearest =
          std::min(nearest, UnlikenessOf(path.WorldFromCam(first), path.WorldFromCam(second)));
    }
  }
  EXPECT_LT(nearest, 0.6);
}

// The distance of a point from the box around an object, metres.
double DistanceTo(const SceneObject& object, const Vector3d& point) {
  const Vector3d local = Inverse(object.world_from_object) * point;
  return (local.cwiseAbs() - object.half_extents).cwiseMax(0.0).norm();
}

TEST(House, AllItsObjectsAreSeenAndNoneIsInTheWay) {
  const int frames = DefaultFrames(SceneKind::kHouse);
  const Scene scene = BuildScene(SceneKind::kHouse, frames, 2);
  EXPECT_GE(scene.objects.size(), 55U);
  EXPECT_LE(scene.objects.size(), 65U);
  const PinholeCamera small = {
      .fx = 133.85, .fy = 134.8, .cx = 80.0, .cy = 61.9, .width = 160, .height = 120};
  const Renderer renderer(scene, small);
  std::map<int, int> sightings;
  for (int i = 0; i < frames; i += 20) {
    const double time = i * kFrame;
    for (const SceneObject& object : scene.objects) {
      EXPECT_GT(DistanceTo(object, scene.world_from_cam(time).translation), 0.3)
          << object.class_name << " " << object.id << " frame " << i;
    }
    const cv::Mat instance = renderer.Render(time).instance;
    std::map<int, int> pixels;
    std::for_each(instance.begin<int16_t>(), instance.end<int16_t>(),
                  [&](int16_t object) { ++pixels[object]; });
    for (const auto& [object, count] : pixels) {
      sightings[object] += count >= 6 ? 1 : 0;  // 100 px of an image with 640x480
    }
  }
  for (const SceneObject& object : scene.objects) {
    EXPECT_GE(sightings[object.id], 1) << object.class_name << " " << object.id;
  }
}

}  // namespace
}  // namespace hullslam::synthetic

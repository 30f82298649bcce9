// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/landmark_projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "support/random_geometry.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// A landmark at (0.4, -0.2, 2) that was observed along z, at level 0 from 4 m.
Landmark MakeLandmark() {
  Landmark landmark;
  landmark.position = {0.4, -0.2, 2.0};
  landmark.viewing_direction = Eigen::Vector3d::UnitZ();
  landmark.max_distance = 4.0;
  landmark.min_distance = 4.0 / std::pow(1.2, 7);
  return landmark;
}

bool IsSeen(const Landmark& landmark, const Rigid3& cam_from_world = {}) {
  return ProjectLandmark(SyntheticSensor(), cam_from_world, landmark).has_value();
}

Rigid3 CameraAt(double x, double y, double z) {
  return {Eigen::Quaterniond::Identity(), {-x, -y, -z}};
}

TEST(ProjectLandmark, ByHand) {
  const auto view = ProjectLandmark(SyntheticSensor(), Rigid3(), MakeLandmark());
  ASSERT_TRUE(view.has_value());
  EXPECT_EQ(view->point_in_cam, Eigen::Vector3d(0.4, -0.2, 2.0));
  EXPECT_NEAR(view->pixel.x(), 500.0 * 0.2 + 320.0, 1e-12);
  EXPECT_NEAR(view->pixel.y(), -500.0 * 0.1 + 240.0, 1e-12);
  EXPECT_NEAR(view->cos_view, 2.0 / std::sqrt(4.2), 1e-12);
  // ln(4 / sqrt(4.2)) / ln(1.2) is 3.67, rounded up.
  EXPECT_EQ(view->level, 4);
}

TEST(ProjectLandmark, DoesNotDependOnTheWorldFrame) {
  RandomGeometry random(1);
  const auto expected = ProjectLandmark(SyntheticSensor(), Rigid3(), MakeLandmark());
  for (int i = 0; i < 20; ++i) {
    const Rigid3 new_from_old = random.Pose(2.0, 5.0);
    Landmark moved = MakeLandmark();
    moved.position = new_from_old * moved.position;
    moved.viewing_direction = new_from_old.rotation * moved.viewing_direction;
    const auto view = ProjectLandmark(SyntheticSensor(), Inverse(new_from_old), moved);
    ASSERT_TRUE(view.has_value());
    EXPECT_LT((view->pixel - expected->pixel).norm(), 1e-9);
    EXPECT_NEAR(view->cos_view, expected->cos_view, 1e-12);
    EXPECT_EQ(view->level, expected->level);
  }
}

TEST(ProjectLandmark, IsNullBehindTheCamera) {
  Landmark landmark = MakeLandmark();
  landmark.position.z() = -2.0;
  landmark.viewing_direction = -Eigen::Vector3d::UnitZ();
  EXPECT_FALSE(IsSeen(landmark));
  landmark.position.z() = 0.0;
  EXPECT_FALSE(IsSeen(landmark));
}

TEST(ProjectLandmark, IsNullOutsideTheImage) {
  // At 2 m the image ends 0.64 * 2 m left and right, 0.48 * 2 m above and below.
  Landmark landmark = MakeLandmark();
  for (const auto& [x, y, is_inside] :
       {std::tuple(-1.279, 0.0, true), std::tuple(-1.281, 0.0, false), std::tuple(1.279, 0.0, true),
        std::tuple(1.281, 0.0, false), std::tuple(0.0, -0.959, true),
        std::tuple(0.0, -0.961, false), std::tuple(0.0, 0.959, true),
        std::tuple(0.0, 0.961, false)}) {
    landmark.position = {x, y, 2.0};
    EXPECT_EQ(IsSeen(landmark), is_inside) << x << ' ' << y;
  }
}

TEST(ProjectLandmark, IsNullFromMuchNearerOrFarther) {
  // The landmark was seen from 1.116 m to 4 m. A factor of 1.2, one level, is added at both ends,
  // so it is expected from 0.930 m to 4.8 m.
  Landmark landmark = MakeLandmark();
  landmark.position = {0.0, 0.0, 0.0};
  EXPECT_TRUE(IsSeen(landmark, CameraAt(0.0, 0.0, -0.931)));
  EXPECT_FALSE(IsSeen(landmark, CameraAt(0.0, 0.0, -0.929)));
  EXPECT_TRUE(IsSeen(landmark, CameraAt(0.0, 0.0, -4.799)));
  EXPECT_FALSE(IsSeen(landmark, CameraAt(0.0, 0.0, -4.801)));
}

TEST(ProjectLandmark, IsNullFromMoreThanSixtyDegreesAway) {
  Landmark landmark = MakeLandmark();
  landmark.position = {0.0, 0.0, 2.0};
  for (const double degrees : {0.0, 59.9, 60.1, 120.0, 180.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    landmark.viewing_direction = {0.0, std::sin(angle), std::cos(angle)};
    EXPECT_EQ(IsSeen(landmark), degrees < 60.0) << degrees;
  }
}

// The reference keyframe sees the landmark at its keypoint and at the level of the keypoint.
TEST(ProjectLandmark, FindsTheKeypointOfTheReferenceKeyframe) {
  const SyntheticWorld world;
  const SyntheticMap made = MakeSyntheticMap(world, {0, 10, 20});
  int checked = 0;
  made.map.landmarks().ForEach([&](LandmarkId, const Landmark& landmark) {
    for (const Observation& observation : landmark.observations) {
      const Keyframe& keyframe = made.map.keyframes().At(observation.keyframe);
      const auto view = ProjectLandmark(world.sensor(), keyframe.cam_from_world, landmark);
      ASSERT_TRUE(view.has_value());
      const Keypoint& keypoint = keyframe.frame->features.keypoints[observation.keypoint];
      EXPECT_LT((view->pixel - keypoint.undistorted.cast<double>()).norm(), 1e-4);
      if (observation.keyframe == landmark.reference) {
        EXPECT_EQ(view->level, keypoint.level);
      }
      ++checked;
    }
  });
  EXPECT_GT(checked, 600);
}

}  // namespace
}  // namespace hullslam

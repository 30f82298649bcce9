// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/pose_hypotheses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "objects/made_room.h"

namespace hullslam {
namespace {

double PositionError(const Rigid3& a, const Rigid3& b) {
  return (Inverse(a).translation - Inverse(b).translation).norm();
}

class PoseHypotheses : public ::testing::Test {
 protected:
  std::vector<PoseHypothesis> Propose(const Map& map, const Frame& frame) const {
    return ProposePoses(map, sensor_.camera, frame, IslandId(0));
  }
  // The smallest error of the position of any hypothesis that is turned by less than 0.3 rad.
  double BestError(const std::vector<PoseHypothesis>& hypotheses) const {
    double best = 100.0;
    for (const PoseHypothesis& hypothesis : hypotheses) {
      if (AngularDistance(hypothesis.cam_from_world.rotation, truth_.rotation) < 0.3) {
        best = std::min(best, PositionError(hypothesis.cam_from_world, truth_));
      }
    }
    return best;
  }
  Sensor sensor_ = MakeObjectSensor();
  const std::vector<MadeObject> room_ = MakeRoom();
  const Rigid3 truth_ = CameraOnCircle(0.9, 1.9, 0.7);  // 40 degrees from the keyframe
};

TEST_F(PoseHypotheses, TheBestOneIsTrueWithNoiseOfCentimetres) {
  Map map;
  AddRoom(map, sensor_, room_);
  for (const double noise : {0.0, 0.02}) {
    const auto found = Propose(map, SeeRoom(sensor_, room_, truth_, noise));
    ASSERT_FALSE(found.empty());
    EXPECT_LT(PositionError(found[0].cam_from_world, truth_), 0.1) << noise;
    EXPECT_GT(found[0].agreement, 4.0);
  }
}

TEST_F(PoseHypotheses, DoNotDependOnTheWorldFrame) {
  const Rigid3 motion(ExpSo3({0.4, -0.8, 1.9}), {3.0, -2.0, 7.0});
  const std::vector<MadeObject> moved = Moved(motion, room_);
  Map map;
  AddRoom(map, sensor_, room_);
  Map moved_map;
  AddRoom(moved_map, sensor_, moved, motion);
  const auto found = Propose(map, SeeRoom(sensor_, room_, truth_, 0.01));
  const auto other = Propose(moved_map, SeeRoom(sensor_, moved, truth_ * Inverse(motion), 0.01));
  ASSERT_EQ(found.size(), other.size());
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].agreement, other[i].agreement, 1e-5);
    EXPECT_LT(PositionError(found[i].cam_from_world * Inverse(motion), other[i].cam_from_world),
              1e-4);
  }
}

TEST_F(PoseHypotheses, WithoutDepthTheRaysAreEnough) {
  Map map;
  AddRoom(map, sensor_, room_);
  const auto found = Propose(map, WithoutDepth(SeeRoom(sensor_, room_, truth_)));
  ASSERT_FALSE(found.empty());
  EXPECT_LT(PositionError(found[0].cam_from_world, truth_), 0.1);
}

TEST_F(PoseHypotheses, WithTwoDetectionsTheAngleIsSearched) {
  const std::vector<MadeObject> two = {room_[2], room_[3]};  // long things
  Map map;
  AddRoom(map, sensor_, two);
  EXPECT_LT(BestError(Propose(map, SeeRoom(sensor_, two, truth_))), 0.3);
  EXPECT_TRUE(Propose(map, SeeRoom(sensor_, {room_[2]}, truth_)).empty());
}

TEST_F(PoseHypotheses, OtherClassesSizesAndDistancesGiveNone) {
  Map map;
  AddRoom(map, sensor_, room_);
  std::vector<MadeObject> others = room_;
  for (MadeObject& other : others) {
    other.label = "chair";
  }
  EXPECT_TRUE(Propose(map, SeeRoom(sensor_, others, truth_)).empty());
  std::vector<MadeObject> larger = room_;
  std::vector<MadeObject> apart = room_;
  for (size_t i = 0; i < room_.size(); ++i) {
    larger[i].ellipsoid.half_axes *= 4.0;
    apart[i].ellipsoid.world_from_object.translation *= 1.0 + 0.5 * static_cast<double>(i);
  }
  EXPECT_TRUE(Propose(map, SeeRoom(sensor_, larger, CameraOnCircle(0.9, 5.0, 0.7))).empty());
  const auto found = Propose(map, SeeRoom(sensor_, apart, CameraOnCircle(0.9, 6.0, 1.0)));
  for (const PoseHypothesis& hypothesis : found) {
    EXPECT_LT(hypothesis.agreement, 4.0);
  }
}

TEST_F(PoseHypotheses, AreDifferentPlaces) {
  Map map;
  AddRoom(map, sensor_, room_);
  const Rigid3 aside(Eigen::Quaterniond::Identity(), {5.0, 0.0, 0.0});
  AddRoom(map, sensor_, Moved(aside, room_), aside);
  const Frame frame = SeeRoom(sensor_, room_, truth_);
  for (const Frame& seen : {frame, WithoutDepth(frame)}) {
    const auto found = Propose(map, seen);
    ASSERT_GE(found.size(), 2U);
    EXPECT_NEAR(found[0].agreement, found[1].agreement, 1e-3);
    EXPECT_NEAR(PositionError(found[0].cam_from_world, found[1].cam_from_world), 5.0, 0.05);
    EXPECT_NEAR(found[0].distance, 2.0, 0.2);
    EXPECT_FALSE(AreSamePlace(found[0].cam_from_world, found[1].cam_from_world, 2.0));
  }
}

// Without depth the unit of length is not known, so nothing may depend on it.
TEST_F(PoseHypotheses, WithoutDepthTheUnitOfLengthDoesNotMatter) {
  constexpr double kUnit = 0.01;
  Map map;
  AddRoom(map, sensor_, room_);
  std::vector<MadeObject> small = room_;
  for (MadeObject& object : small) {
    object.ellipsoid.half_axes *= kUnit;
    object.ellipsoid.world_from_object.translation *= kUnit;
  }
  Map small_map;
  AddRoom(small_map, sensor_, small, Rigid3());
  const Frame frame = WithoutDepth(SeeRoom(sensor_, room_, truth_));
  const auto found = Propose(map, frame);
  const auto other = Propose(small_map, frame);
  ASSERT_FALSE(found.empty());
  ASSERT_EQ(found.size(), other.size());
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].distance * kUnit, other[i].distance, 1e-6);
  }
}

TEST(SamePlace, DependsOnTheDepthOfTheScene) {
  const Rigid3 moved(Eigen::Quaterniond::Identity(), {0.2, 0.0, 0.0});
  EXPECT_TRUE(AreSamePlace(Rigid3(), moved, 2.0));
  EXPECT_FALSE(AreSamePlace(Rigid3(), moved, 1.0));
  const Rigid3 turned(ExpSo3({0.0, 0.2, 0.0}), Eigen::Vector3d::Zero());
  EXPECT_FALSE(AreSamePlace(Rigid3(), turned, 2.0));
}

}  // namespace
}  // namespace hullslam

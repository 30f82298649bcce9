// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/pose_hypotheses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "objects/made_room.h"
#include "support/random_geometry.h"

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

TEST(SamePlace, HasTheSameBoundsEverywhere) {
  const auto moved = [](double way) {
    return Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, way, 0.0));
  };
  EXPECT_TRUE(AreSamePlace(Rigid3(), moved(0.29), 2.0));
  EXPECT_FALSE(AreSamePlace(Rigid3(), moved(0.31), 2.0));
  const auto turned = [](double angle) {
    return Rigid3(ExpSo3({angle, 0.0, 0.0}), Eigen::Vector3d::Zero());
  };
  EXPECT_TRUE(AreSamePlace(Rigid3(), turned(0.14), 2.0));
  EXPECT_FALSE(AreSamePlace(Rigid3(), turned(0.16), 2.0));
}

// Each place is proposed once, whether its distance is known or not.
TEST_F(PoseHypotheses, AreOfDifferentPlaces) {
  Map map;
  AddRoom(map, sensor_, room_);
  const Frame frame = SeeRoom(sensor_, room_, truth_, 0.01);
  for (const bool has_depth : {true, false}) {
    const auto found = Propose(map, has_depth ? frame : WithoutDepth(frame));
    ASSERT_FALSE(found.empty());
    for (size_t i = 0; i < found.size(); ++i) {
      for (size_t k = 0; k < i; ++k) {
        EXPECT_FALSE(AreSamePlace(found[i].cam_from_world, found[k].cam_from_world, 1.5))
            << has_depth << ": " << k << ", " << i;
      }
    }
  }
}

TEST_F(PoseHypotheses, AreOfMappedObjectsOfTheIslandThatAreSeenAsAWhole) {
  Map map;
  AddRoom(map, sensor_, room_);
  Frame frame = SeeRoom(sensor_, room_, truth_);
  EXPECT_FALSE(Propose(map, frame).empty());
  EXPECT_TRUE(ProposePoses(map, sensor_.camera, frame, IslandId(1)).empty());
  for (Detection& detection : frame.detections) {
    detection.is_cut = true;
  }
  EXPECT_TRUE(Propose(map, frame).empty());
  for (Detection& detection : frame.detections) {
    detection.is_cut = false;
  }
  for (uint32_t i = 0; i < room_.size(); ++i) {
    map.MutableObject(ObjectId(i)).state = ObjectState::kCandidate;
  }
  EXPECT_TRUE(Propose(map, frame).empty());
}

// The ball is 1.9 m away and has a radius of 0.11 m, so the tolerance of its centre is 7 cm. Its
// agreement falls to 1 - (10 cm / 14 cm)^2 if its depth is wrong by 10 cm.
TEST_F(PoseHypotheses, TheAgreementFallsWithTheDeviationOfACentre) {
  Map map;
  AddRoom(map, sensor_, room_);
  Frame frame = SeeRoom(sensor_, room_, truth_);
  const PoseHypothesis before = Propose(map, frame).at(0);
  EXPECT_GT(before.agreement, 6.5);
  Detection& ball = frame.detections[4];
  ASSERT_EQ(ball.label, "ball");
  std::vector<Eigen::Vector3d> points = ball.points.Unpack();
  for (Eigen::Vector3d& point : points) {
    point += 0.1 * point.normalized();
  }
  ball.points = points;
  const PoseHypothesis after = Propose(map, frame).at(0);
  EXPECT_NEAR(before.agreement - after.agreement, 0.5, 0.1);
  EXPECT_NEAR(after.distance, before.distance, 0.03);  // a mean, weighted by the agreements
}

TEST_F(PoseHypotheses, WithoutDepthOtherSizesGiveNone) {
  Map map;
  AddRoom(map, sensor_, room_);
  std::vector<MadeObject> larger = room_;
  for (MadeObject& object : larger) {
    object.ellipsoid.half_axes *= 4.0;
  }
  const Frame frame = WithoutDepth(SeeRoom(sensor_, larger, CameraOnCircle(0.9, 5.0, 0.7)));
  for (const PoseHypothesis& hypothesis : Propose(map, frame)) {
    EXPECT_LT(PositionError(hypothesis.cam_from_world, Rigid3()), 100.0);
    EXPECT_GE(hypothesis.agreement, 1.0);
  }
}

TEST_F(PoseHypotheses, TwoDetectionsNeedDepthAndTwoObjects) {
  const std::vector<MadeObject> two = {room_[2], room_[3]};
  Map map;
  AddRoom(map, sensor_, two);
  const Frame frame = SeeRoom(sensor_, two, truth_);
  for (const PoseHypothesis& hypothesis : Propose(map, frame)) {
    EXPECT_GT(hypothesis.agreement, 0.0);
    EXPECT_NEAR(hypothesis.distance, 2.0, 0.2);
  }
  EXPECT_TRUE(Propose(map, WithoutDepth(frame)).empty());
  Map map_of_one;
  AddRoom(map_of_one, sensor_, {room_[2]});
  EXPECT_TRUE(Propose(map_of_one, SeeRoom(sensor_, {room_[2], room_[2]}, truth_, 0.01)).empty());
}

// The angles are 10 degrees apart, so one of them is wrong by at most 5 degrees.
TEST_F(PoseHypotheses, OfTwoDetectionsTheAngleIsFoundToFiveDegrees) {
  const std::vector<MadeObject> two = {room_[2], room_[3]};
  Map map;
  AddRoom(map, sensor_, two);
  for (int i = 0; i < 12; ++i) {
    const Rigid3 camera = CameraOnCircle(0.5 * i, 1.9, 0.7);
    double best = 10.0;
    for (const PoseHypothesis& hypothesis : Propose(map, SeeRoom(sensor_, two, camera))) {
      best = std::min(best, AngularDistance(hypothesis.cam_from_world.rotation, camera.rotation));
    }
    EXPECT_LT(best, 0.11) << i;
  }
}

// Many rooms that look the same, 5 m apart.
TEST_F(PoseHypotheses, AreAtMostTwentyFour) {
  Map map;
  for (int i = 0; i < 30; ++i) {
    const Rigid3 aside(Eigen::Quaterniond::Identity(), {5.0 * i, 0.0, 0.0});
    AddRoom(map, sensor_, Moved(aside, room_), aside);
  }
  EXPECT_EQ(Propose(map, SeeRoom(sensor_, room_, truth_)).size(), 24U);
}

// Other objects of the classes of the room, which come before those of the room. Without depth all
// triples fit together, so the true one is the last of those of the first three detections.
class ManyTriples : public PoseHypotheses {
 protected:
  // Whether the true pose is found; `others` gives the number of other objects of each class.
  bool IsFound(const std::vector<int>& others) const {
    Map map;
    RandomGeometry random(1);
    const KeyframeId keyframe = AddObserver(map, sensor_, truth_, {});
    for (size_t i = 0; i < room_.size(); ++i) {
      for (int k = 0; k < others[i]; ++k) {
        ObjectLandmark& other = map.MutableObject(map.AddObject());
        other.state = ObjectState::kMapped;
        other.ellipsoid = room_[i].ellipsoid;
        other.ellipsoid.world_from_object.translation = random.Vector(10.0);
        other.votes = {{room_[i].label, 1.0}};
        other.reference = keyframe;
      }
    }
    AddRoom(map, sensor_, room_);
    return BestError(Propose(map, WithoutDepth(SeeRoom(sensor_, room_, truth_)))) < 0.1;
  }
};

TEST_F(ManyTriples, AThousandOrMoreAreTried) {
  EXPECT_TRUE(IsFound({20, 20, 11, 11, 11, 11, 11}));  // 12^3 triples come first
}
TEST_F(ManyTriples, TheirNumberIsBounded) {
  EXPECT_FALSE(IsFound({20, 20, 15, 15, 15, 15, 15}));  // 16^3
}
TEST_F(ManyTriples, DetectionsWithFewCandidatesComeFirst) {
  EXPECT_TRUE(IsFound({40, 40, 20, 20, 0, 0, 0}));
}

// Pairs of the same classes and at the same distance, whose things lie in another direction. They
// come before the true pair.
class ManyPairs : public PoseHypotheses {
 protected:
  bool IsFound(int others) const {
    const std::vector<MadeObject> two = {room_[2], room_[3]};
    std::vector<MadeObject> other = two;
    for (MadeObject& object : other) {
      object.ellipsoid.world_from_object.rotation =
          object.ellipsoid.world_from_object.rotation * ExpSo3({1.2, 0.9, 0.0});
    }
    Map map;
    for (int i = 0; i < others; ++i) {
      const Rigid3 aside(Eigen::Quaterniond::Identity(), {5.0 * (i + 1), 0.0, 0.0});
      AddRoom(map, sensor_, Moved(aside, other), aside);
    }
    AddRoom(map, sensor_, two);
    return BestError(Propose(map, SeeRoom(sensor_, two, truth_))) < 0.3;
  }
};

TEST_F(ManyPairs, FiftyAreTried) { EXPECT_TRUE(IsFound(50)); }
TEST_F(ManyPairs, TheirNumberIsBounded) { EXPECT_FALSE(IsFound(60)); }

// The frame with one detection moved along its ray (m).
Frame WithDepthError(Frame frame, size_t detection, double error) {
  std::vector<Eigen::Vector3d> points = frame.detections[detection].points.Unpack();
  for (Eigen::Vector3d& point : points) {
    point += error * point.normalized();
  }
  frame.detections[detection].points = points;
  return frame;
}

// One behind the other. The distance of two centres may be wrong by the tolerances of both, 13 cm.
TEST_F(PoseHypotheses, TheTolerancesOfTwoCentresAddUp) {
  std::vector<MadeObject> two = {room_[2], room_[3]};
  two[0].ellipsoid.world_from_object.translation = {0.4, 0.0, 0.0};
  two[1].ellipsoid.world_from_object.translation = {-0.4, 0.0, 0.0};
  Map map;
  AddRoom(map, sensor_, two);
  const Frame frame = SeeRoom(sensor_, two, CameraOnCircle(0.0, 1.9, 0.7));
  EXPECT_FALSE(Propose(map, WithDepthError(frame, 1, 0.11)).empty());
  EXPECT_TRUE(Propose(map, WithDepthError(frame, 1, 0.2)).empty());
}

// The distance of two of three centres is wrong, so only pairs fit together.
TEST_F(PoseHypotheses, AllDistancesOfATripleMustFit) {
  std::vector<MadeObject> three = {room_[2], room_[3], room_[4]};
  three[0].ellipsoid.world_from_object.translation = {0.6, -0.3, 0.0};
  three[1].ellipsoid.world_from_object.translation = {-0.2, -0.4, 0.0};
  three[2].ellipsoid.world_from_object.translation = {-0.2, 0.4, 0.0};
  Map map;
  AddRoom(map, sensor_, three);
  const Frame exact = SeeRoom(sensor_, three, CameraOnCircle(0.0, 1.9, 0.7));
  EXPECT_GT(Propose(map, exact).at(0).agreement, 2.5);
  Frame wrong = WithDepthError(exact, 2, 0.25);
  for (int turn = 0; turn < 3; ++turn) {
    std::rotate(wrong.detections.begin(), wrong.detections.begin() + 1, wrong.detections.end());
    EXPECT_GT(Propose(map, wrong).size(), 4U) << turn;
  }
}

TEST_F(PoseHypotheses, ThreeRaysAreEnoughFromEverySide) {
  const std::vector<MadeObject> three = {room_[2], room_[3], room_[5]};
  Map map;
  AddRoom(map, sensor_, three);
  for (int i = 0; i < 12; ++i) {
    const Rigid3 camera = CameraOnCircle(0.5 * i, 1.9, 0.7);
    double best = 10.0;
    for (const auto& found : Propose(map, WithoutDepth(SeeRoom(sensor_, three, camera)))) {
      best = std::min(best, PositionError(found.cam_from_world, camera));
    }
    EXPECT_LT(best, 0.1) << i;
  }
}

TEST_F(PoseHypotheses, BothOfTwoDetectionsNeedDepth) {
  const std::vector<MadeObject> two = {room_[2], room_[3]};
  Map map;
  AddRoom(map, sensor_, two);
  for (const size_t without : {0U, 1U}) {
    Frame frame = SeeRoom(sensor_, two, truth_);
    frame.detections[without].points.clear();
    EXPECT_TRUE(Propose(map, frame).empty()) << without;
  }
}

// Without depth, three things give the pose. The ball agrees with it only if it is in front of the
// camera and has the size that its detection shows.
TEST_F(PoseHypotheses, WithoutDepthAnObjectAgreesOnlyWithItsSizeAndInFront) {
  const std::vector<MadeObject> four = {room_[2], room_[3], room_[5], room_[4]};
  std::vector<MadeObject> larger = four;
  larger[3].ellipsoid.half_axes *= 4.0;
  Map map;
  AddRoom(map, sensor_, four);
  const Frame frame = WithoutDepth(SeeRoom(sensor_, four, truth_));
  EXPECT_GT(Propose(map, frame).at(0).agreement, 3.8);
  EXPECT_NEAR(Propose(map, WithoutDepth(SeeRoom(sensor_, larger, truth_))).at(0).agreement, 3.0,
              0.2);

  Eigen::Vector3d& center = map.MutableObject(ObjectId(3)).ellipsoid.world_from_object.translation;
  center = Inverse(truth_) * -(truth_ * center);  // on the same line, behind the camera
  EXPECT_NEAR(Propose(map, frame).at(0).agreement, 3.0, 0.2);
}

}  // namespace
}  // namespace hullslam

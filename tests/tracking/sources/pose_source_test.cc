// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sources/pose_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "matching/by_descriptor.h"
#include "objects/made_room.h"
#include "support/ring_world.h"
#include "support/synthetic_world.h"
#include "support/test_cameras.h"
#include "tracking/pose_refinement.h"
#include "tracking/sources/confirmed_pose.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

// The camera was at the pose of keyframe 0 and moved on by `motion` in the time of one frame.
class MotionModel : public testing::TestWithParam<TestCamera> {
 protected:
  LastFrame LastFrameAtKeyframe(const Rigid3& motion) const {
    const Keyframe& keyframe = made_.map.keyframes().At(KeyframeId(0));
    LastFrame last;
    last.frame = keyframe.frame;
    last.landmarks = keyframe.landmarks;
    last.reference = KeyframeId(0);
    last.cam_from_world = keyframe.cam_from_world;
    last.motion = CameraMotion{motion, 1.0 / world_.sensor().frames_per_second};
    return last;
  }
  // The pose that is found for a frame with the true pose `truth`, if the motion model predicts
  // `motion`.
  std::optional<PoseEstimate> Estimate(const Rigid3& motion, const Rigid3& truth,
                                       int max_level = 7) const {
    SyntheticView view = world_.Observe(FrameId(100), truth);
    auto frame = std::make_shared<Frame>(*view.frame);
    for (size_t i = 0; i < frame->features.size(); ++i) {
      if (frame->features.keypoints[i].level > max_level) {
        frame->features.descriptors[i] = {};  // then the keypoint is not recognised
      }
    }
    LastFrame last = LastFrameAtKeyframe(motion);
    frame->timestamp = last.frame->timestamp + last.motion->duration;
    return PoseByMotionModel(*frame, made_.map, {world_.sensor(), options_, objects_, index_},
                             last);
  }
  static Rigid3 Forward(double metres) {
    return {Eigen::Quaterniond::Identity(), {0.0, 0.0, -metres}};
  }

  const SyntheticWorld world_{{}, GetParam().sensor};
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 5});
  TrackingOptions options_;
  ObjectOptions objects_;
  const ObjectIndex index_{};
};

HULLSLAM_WITH_ALL_CAMERAS(MotionModel);

// Patches grow and shrink by several levels of the pyramid when the camera moves by metres.
TEST_P(MotionModel, FindsPatchesThatChangedTheirSize) {
  const Rigid3 start = made_.map.keyframes().At(KeyframeId(0)).cam_from_world;
  const auto still = Estimate(Rigid3(), start);
  ASSERT_TRUE(still);
  EXPECT_GT(still->inliers, 200);
  const auto back = Estimate(Forward(-3.0), Forward(-3.0) * start);
  ASSERT_TRUE(back);
  EXPECT_GT(back->inliers, still->inliers * 9 / 10);  // all are still in the image
  const auto forward = Estimate(Forward(1.0), Forward(1.0) * start);
  ASSERT_TRUE(forward);
  EXPECT_GT(forward->inliers, still->inliers / 4);  // many have left the image
}

// 25 px are more than the window at the finest levels, but less than the wider one.
TEST_P(MotionModel, SearchesAWiderWindowIfTooLittleIsFound) {
  const Rigid3 start = made_.map.keyframes().At(KeyframeId(0)).cam_from_world;
  const double turn = 25.0 / world_.sensor().camera.fx;
  const Rigid3 truth = Rigid3(ExpSo3({0.0, turn, 0.0}), Eigen::Vector3d::Zero()) * start;
  const auto wide = Estimate(Rigid3(), truth, 1);
  ASSERT_TRUE(wide);
  EXPECT_LT(AngularDistance(wide->cam_from_world.rotation, truth.rotation), 1e-3);
  const Rigid3 far = Rigid3(ExpSo3({0.0, 2.0 * turn, 0.0}), Eigen::Vector3d::Zero()) * start;
  EXPECT_FALSE(Estimate(Rigid3(), far, 1));
}

// The reference keyframe of the last frame is keyframe 3 of a ring map. Of the last frame only the
// pose is known.
class ByReferenceKeyframe : public testing::TestWithParam<bool> {
 protected:
  std::optional<PoseEstimate> Find(const Frame& frame) const {
    return Find(frame, made_.map.keyframes().At(KeyframeId(3)).cam_from_world);
  }
  std::optional<PoseEstimate> Find(const Frame& frame, const Rigid3& last_pose) const {
    LastFrame last;
    last.frame = made_.map.keyframes().At(KeyframeId(3)).frame;
    last.reference = KeyframeId(3);
    last.cam_from_world = last_pose;
    return PoseByReferenceKeyframe(frame, made_.map, {world_.sensor(), options_, objects_, index_},
                                   last);
  }

  const RingWorld& world_ = SharedRing();
  const RingMap made_ =
      MakeRingMap(world_, {.keyframes = 16, .drift = Rigid3(), .has_vocabulary = GetParam()});
  TrackingOptions options_;
  ObjectOptions objects_;
  const ObjectIndex index_{};
};

TEST_P(ByReferenceKeyframe, FindsFramesNearIt) {
  for (const double turns : {2.5 / 24.0, 3.0 / 24.0, 3.4 / 24.0}) {
    const Rigid3 truth = RingWorld::CamFromWorld(turns);
    const auto estimate = Find(*world_.Observe(FrameId(1000), truth).frame);
    ASSERT_TRUE(estimate) << turns;
    EXPECT_LT((estimate->cam_from_world.translation - truth.translation).norm(), 0.01);
    EXPECT_LT(AngularDistance(estimate->cam_from_world.rotation, truth.rotation), 0.003);
    EXPECT_GT(estimate->inliers, 40);
  }
}

// After a fast turn, or in a recording of few images, the last pose says little. If most of the
// matches are wrong, a refinement that begins there ends at a wrong pose.
TEST_P(ByReferenceKeyframe, FindsFramesFarFromTheLastPoseAmongWrongMatches) {
  const Rigid3 truth = RingWorld::CamFromWorld(3.0 / 24.0);
  Frame frame = *world_.Observe(FrameId(1000), truth).frame;
  frame.words = {};
  std::ranges::fill(frame.features.depth, 0.0F);
  std::vector<Keypoint>& keypoints = frame.features.keypoints;
  for (size_t i = 0; i + 2 < keypoints.size(); i += 3) {
    std::swap(keypoints[i].undistorted, keypoints[i + 2].undistorted);
  }
  for (const double turn : {0.8, 1.2, 1.6, 2.4}) {
    const Rigid3 last = Rigid3(ExpSo3({0.0, turn, 0.0}), {0.0, 0.0, 0.5}) * truth;
    const auto estimate = Find(frame, last);
    ASSERT_TRUE(estimate) << turn;
    EXPECT_LT((estimate->cam_from_world.translation - truth.translation).norm(), 0.01);
    EXPECT_LT(AngularDistance(estimate->cam_from_world.rotation, truth.rotation), 0.003);
  }
}

TEST_P(ByReferenceKeyframe, DoesNotFindOthers) {
  EXPECT_FALSE(Find(*world_.Observe(FrameId(1000), RingWorld::CamFromWorld(0.5)).frame));
}

// A frame may have no words although the map has a vocabulary.
TEST_P(ByReferenceKeyframe, DoesNotNeedWords) {
  Frame frame = *world_.Observe(FrameId(1000), RingWorld::CamFromWorld(0.125)).frame;
  frame.words = {};
  EXPECT_TRUE(Find(frame));
}

INSTANTIATE_TEST_SUITE_P(Vocabulary, ByReferenceKeyframe, testing::Bool());

// A ring map without drift. The last frame is empty: nothing is known of the motion.
class Relocalisation : public testing::Test {
 protected:
  std::optional<PoseEstimate> Find(const Frame& frame) const { return Find(frame, made_.map); }
  std::optional<PoseEstimate> Find(const Frame& frame, const Map& map) const {
    return PoseByRelocalisation(frame, map, {world_.sensor(), options_, objects_, index_, 1}, {});
  }
  // A frame of the ring at any place.
  SyntheticView Look(double turns) const {
    return world_.Observe(FrameId(1000), RingWorld::CamFromWorld(turns));
  }

  const RingWorld& world_ = SharedRing();
  const RingMap made_ = MakeRingMap(world_, {.keyframes = 16, .drift = Rigid3()});
  TrackingOptions options_;
  ObjectOptions objects_;
  const ObjectIndex index_{};
};

TEST_F(Relocalisation, FindsFramesOfTheMapWithoutTheLastFrame) {
  for (const double turns : {0.02, 0.1, 0.23, 0.31, 0.5, 0.6}) {
    const SyntheticView view = Look(turns);
    const auto estimate = Find(*view.frame);
    ASSERT_TRUE(estimate) << turns;
    const Rigid3 truth = RingWorld::CamFromWorld(turns);
    EXPECT_LT((estimate->cam_from_world.translation - truth.translation).norm(), 0.005);
    EXPECT_LT(AngularDistance(estimate->cam_from_world.rotation, truth.rotation), 0.002);
    EXPECT_GT(estimate->inliers, 100);
  }
}

TEST_F(Relocalisation, ItsLandmarksAreThoseThatTheFrameShows) {
  const SyntheticView view = Look(0.3);
  const auto estimate = Find(*view.frame);
  ASSERT_TRUE(estimate);
  ASSERT_EQ(estimate->landmarks.size(), view.points.size());
  IdSet<LandmarkId> found;
  int count = 0;
  for (size_t i = 0; i < view.points.size(); ++i) {
    if (const LandmarkId id = estimate->landmarks[i]; id.IsValid()) {
      const Observation& seen = made_.map.landmarks().At(id).observations.front();
      EXPECT_EQ(made_.views[seen.keyframe.value].points[seen.keypoint], view.points[i]);
      EXPECT_TRUE(found.Insert(id)) << "the landmark was found at two keypoints";
      ++count;
    }
  }
  EXPECT_EQ(count, estimate->inliers);
}

// The matches by words are with the landmarks of one keyframe, which sees only a part of them.
TEST_F(Relocalisation, SeesTheWholePlace) {
  const auto estimate = Find(*Look(4.5 / 24.0).frame);
  ASSERT_TRUE(estimate);
  size_t most = 0;
  made_.map.keyframes().ForEach([&](KeyframeId, const Keyframe& keyframe) {
    size_t common = 0;
    for (const LandmarkId id : estimate->landmarks) {
      common += id.IsValid() && std::count(keyframe.landmarks.begin(), keyframe.landmarks.end(), id)
                    ? 1
                    : 0;
    }
    most = std::max(most, common);
  });
  EXPECT_GT(static_cast<size_t>(estimate->inliers), most + 10);
}

TEST_F(Relocalisation, DoesNotFindAPlaceThatTheMapLacks) {
  EXPECT_FALSE(Find(*Look(0.82).frame)) << "the map ends after two thirds of the turn";
  const RingWorld other({.points = 300, .seed = 9});
  Frame frame = *other.Observe(FrameId(0), Rigid3()).frame;
  frame.words = world_.vocabulary()->WordsOf(frame.features.descriptors);
  EXPECT_FALSE(Find(frame));
}

// The last turn of this map is mapped again with a drift. With a small one both poses are at one
// place.
TEST_F(Relocalisation, AnswersNothingIfTwoPlacesLookAlike) {
  const auto find = [&](double drift) {
    const RingMap twice = MakeRingMap(
        world_,
        {.keyframes = 30, .drift = Rigid3(Eigen::Quaterniond::Identity(), {drift, 0.0, 0.0})});
    return Find(*Look(0.1).frame, twice.map);
  };
  EXPECT_TRUE(find(0.05));
  EXPECT_FALSE(find(30.0));
}

// Also a pose that objects have found must not be one of several.
TEST_F(Relocalisation, APoseHasARivalIfAnotherPlaceLooksTheSame) {
  const Frame frame = *Look(0.1).frame;
  const PoseEstimate found = *Find(frame);
  const auto has_rival = [&](double drift) {
    const RingMap map = MakeRingMap(
        world_,
        {.keyframes = 30, .drift = Rigid3(Eigen::Quaterniond::Identity(), {drift, 0.0, 0.0})});
    return HasRival(frame, map.map, {world_.sensor(), options_, objects_, index_, 1}, KeyframeId(0),
                    found);
  };
  EXPECT_FALSE(has_rival(0.05));
  EXPECT_TRUE(has_rival(30.0));
  options_.relocalise_by_words = false;
  EXPECT_FALSE(has_rival(30.0));
}

TEST_F(Relocalisation, NeedsWordsOfFrameAndMap) {
  Frame frame = *Look(0.3).frame;
  EXPECT_TRUE(Find(frame));
  const RingMap without =
      MakeRingMap(world_, {.keyframes = 16, .drift = Rigid3(), .has_vocabulary = false});
  EXPECT_FALSE(Find(frame, without.map));
  frame.words = {};
  EXPECT_FALSE(Find(frame));
}

TEST_F(Relocalisation, AsksForMoreInliersThanTracking) {
  const Frame frame = *Look(0.3).frame;
  const auto estimate = Find(frame);
  ASSERT_TRUE(estimate);
  options_.min_inliers = estimate->inliers * 3 / 5 - 1;
  EXPECT_TRUE(Find(frame)) << "5 / 3 of it are needed";
  options_.min_inliers = estimate->inliers * 3 / 5 + 2;
  EXPECT_FALSE(Find(frame)) << "enough for tracking, but not for relocalisation";
}

TEST_F(Relocalisation, TheSameFrameGivesTheSameBits) {
  const Frame frame = *Look(0.3).frame;
  const auto a = Find(frame);
  const auto b = Find(frame);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->cam_from_world.rotation.coeffs(), b->cam_from_world.rotation.coeffs());
  EXPECT_EQ(a->cam_from_world.translation, b->cam_from_world.translation);
  EXPECT_EQ(a->landmarks, b->landmarks);
}

// A room of seven objects without any landmark.
class ByObjects : public testing::Test {
 protected:
  ByObjects() { sensor_.levels = ScaleLevels::Create(8, 1.2); }
  std::optional<PoseEstimate> Find(const Map& map, const Frame& frame) const {
    const ObjectIndex index(map, sensor_.camera);
    return PoseByObjects(frame, map, {sensor_, options_, objects_, index}, LastFrame());
  }
  static double Error(const PoseEstimate& found, const Rigid3& truth) {
    return (Inverse(found.cam_from_world).translation - Inverse(truth).translation).norm();
  }
  Sensor sensor_ = MakeObjectSensor();
  TrackingOptions options_;
  ObjectOptions objects_;
  const std::vector<MadeObject> room_ = MakeRoom();
  const Rigid3 truth_ = CameraOnCircle(0.9, 1.9, 0.7);
};

TEST_F(ByObjects, FindThePoseInSpiteOfNoise) {
  Map map;
  AddRoom(map, sensor_, room_);
  const auto exact = Find(map, SeeRoom(sensor_, room_, truth_));
  ASSERT_TRUE(exact);
  EXPECT_LT(Error(*exact, truth_), 0.01);
  EXPECT_EQ(exact->used_objects, 7);
  EXPECT_EQ(exact->keyframe_of_place, KeyframeId(0));
  const auto noisy = Find(map, SeeRoom(sensor_, room_, truth_, 0.02));
  ASSERT_TRUE(noisy);
  EXPECT_LT(Error(*noisy, truth_), 0.1);
}

TEST_F(ByObjects, TheWorldMayBeAnywhere) {
  const Rigid3 motion(ExpSo3({0.4, -0.8, 1.9}), {3.0, -2.0, 7.0});
  Map map;
  AddRoom(map, sensor_, Moved(motion, room_), motion);
  const auto found = Find(map, SeeRoom(sensor_, room_, truth_));
  ASSERT_TRUE(found);
  EXPECT_LT(Error(*found, truth_ * Inverse(motion)), 0.01);
}

TEST_F(ByObjects, GiveTheSameBitsAgain) {
  Map map;
  AddRoom(map, sensor_, room_);
  const Frame frame = SeeRoom(sensor_, room_, truth_, 0.02);
  EXPECT_EQ(Find(map, frame)->cam_from_world.ToMatrix(),
            Find(map, frame)->cam_from_world.ToMatrix());
}

TEST_F(ByObjects, AreAmbiguousInTwoEqualRooms) {
  Map map;
  AddRoom(map, sensor_, room_);
  const Rigid3 aside(Eigen::Quaterniond::Identity(), {5.0, 0.0, 0.0});
  std::vector<MadeObject> other = Moved(aside, room_);
  AddRoom(map, sensor_, other, aside);
  const Frame frame = SeeRoom(sensor_, room_, truth_);
  EXPECT_FALSE(Find(map, frame));
  EXPECT_FALSE(Find(map, WithoutDepth(frame)));
}

TEST_F(ByObjects, FindThePoseWithoutDepth) {
  Map map;
  AddRoom(map, sensor_, room_);
  const auto found = Find(map, WithoutDepth(SeeRoom(sensor_, room_, truth_)));
  ASSERT_TRUE(found);
  EXPECT_LT(Error(*found, truth_), 0.01);
}

TEST_F(ByObjects, RefuseAnUnknownArrangement) {
  Map map;
  AddRoom(map, sensor_, room_);
  std::vector<MadeObject> moved = room_;
  for (size_t i = 0; i < room_.size(); ++i) {
    Eigen::Vector3d& center = moved[i].ellipsoid.world_from_object.translation;
    center = Eigen::Vector3d(-center.y(), 0.4 - center.z(), center.x()) * 0.9;
  }
  EXPECT_FALSE(Find(map, SeeRoom(sensor_, moved, truth_)));
}

TEST_F(ByObjects, RefuseTooFewObjects) {
  Map map;
  AddRoom(map, sensor_, room_);
  EXPECT_FALSE(Find(map, SeeRoom(sensor_, {room_[0], room_[1], room_[2]}, truth_)));
}

TEST_F(ByObjects, CanBeSwitchedOff) {
  Map map;
  AddRoom(map, sensor_, room_);
  const Frame frame = SeeRoom(sensor_, room_, truth_);
  options_.relocalise_by_objects = false;
  EXPECT_FALSE(Find(map, frame));
  options_.relocalise_by_objects = true;
  objects_.enabled = false;
  EXPECT_FALSE(Find(map, frame));
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/last_frame.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "hullslam/util/check.h"
#include "map/compaction.h"
#include "map/made_map.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

Rigid3 Shift(double x) { return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0.0, 0.0)}; }

// A keyframe of frame 0 with two landmarks, and a later frame that sees both of them.
class LastFrameTest : public testing::Test {
 protected:
  LastFrameTest() {
    keyframe_ = map_.AddKeyframe(MakeFrame(0, 2, 2), Shift(1.0));
    landmarks_ = Share(map_, {keyframe_}, 2);
    last_.frame = MakeFrame(1, 2);
    last_.landmarks = landmarks_;
    last_.pose = map_.RelativeTo(keyframe_, Shift(3.0));
    last_.reference = keyframe_;
    last_.motion = CameraMotion{Shift(0.4), 0.1};
    last_.velocity = TimedVelocity{{.linear = {4.0, 0.0, 0.0}}, 0.1, 0.0};
  }

  Map map_;
  KeyframeId keyframe_;
  std::vector<LandmarkId> landmarks_;
  LastFrame last_;
};

TEST_F(LastFrameTest, ThePoseFollowsTheReferenceKeyframe) {
  map_.SetPose(keyframe_, Shift(11.0));
  const LastFrame followed = FollowMap(map_, last_);
  EXPECT_EQ(followed.cam_from_world.translation.x(), 13.0);
  EXPECT_EQ(followed.motion->cam_from_last_cam.translation.x(), 0.4);
  EXPECT_EQ(followed.landmarks, landmarks_);
}

// A correction may shrink the map: the pose relative to the reference and the motion shrink too.
TEST_F(LastFrameTest, PoseAndMotionFollowTheUnitOfLength) {
  map_.MutableKeyframe(keyframe_).cam_from_world = Shift(0.25);
  map_.MutableKeyframe(keyframe_).scale = 0.25;
  const LastFrame followed = FollowMap(map_, last_);
  EXPECT_DOUBLE_EQ(followed.cam_from_world.translation.x(), 0.75);
  EXPECT_DOUBLE_EQ(followed.motion->cam_from_last_cam.translation.x(), 0.1);
  EXPECT_DOUBLE_EQ(followed.velocity->velocity.linear.x(), 1.0);
}

// Only the change since the frame was tracked counts: the reference had been shrunk before.
TEST_F(LastFrameTest, TheMotionIsScaledByTheQuotientOfTheScales) {
  map_.MutableKeyframe(keyframe_).scale = 0.5;
  last_.pose = map_.RelativeTo(keyframe_, Shift(3.0));
  map_.MutableKeyframe(keyframe_).scale = 0.25;
  EXPECT_DOUBLE_EQ(FollowMap(map_, last_).motion->cam_from_last_cam.translation.x(), 0.2);
}

TEST_F(LastFrameTest, AFrameThatBecameAKeyframeHasItsPoseAndLandmarks) {
  const KeyframeId made = map_.AddKeyframe(MakeFrame(1, 2), Shift(5.0));
  const LandmarkId landmark = Share(map_, {made})[0];
  const LastFrame followed = FollowMap(map_, last_);
  EXPECT_EQ(followed.reference, made);
  EXPECT_EQ(followed.cam_from_world.translation.x(), 5.0);
  EXPECT_EQ(followed.landmarks, (std::vector<LandmarkId>{landmark, LandmarkId()}));
}

// The mapper may remove keypoints of a keyframe while tracking is lost.
TEST_F(LastFrameTest, AFrameThatBecameACompactKeyframeHasOneLandmarkPerKeypoint) {
  const KeyframeId made = map_.AddKeyframe(MakeFrame(1, 2), Shift(5.0));
  const LandmarkId landmark = map_.AddLandmark({0.0, 0.0, 2.0}, made);
  map_.AddObservation(landmark, made, 1);
  CompactKeyframe(map_, made);
  const LastFrame followed = FollowMap(map_, last_);
  EXPECT_EQ(followed.landmarks, std::vector<LandmarkId>{landmark});
  ASSERT_EQ(followed.frame->features.size(), 1u);
  EXPECT_EQ(followed.frame->features.keypoints[0].undistorted.x(), 31.0f) << "the second keypoint";
  EXPECT_EQ(followed.frame->id, last_.frame->id);
  EXPECT_EQ(FollowMap(map_, followed).landmarks, followed.landmarks);
}

TEST_F(LastFrameTest, IfTwoLandmarksBecameOneTheFirstKeypointKeepsIt) {
  map_.ReplaceLandmark(landmarks_[1], landmarks_[0]);
  const LastFrame followed = FollowMap(map_, last_);
  EXPECT_EQ(followed.landmarks, (std::vector<LandmarkId>{landmarks_[0], LandmarkId()}));
}

TEST_F(LastFrameTest, AFrameThatTheMapDoesNotKnowIsRefused) {
  last_.pose.reset();
  EXPECT_THROW(FollowMap(map_, last_), CheckError);
}

TEST_F(LastFrameTest, MotionSinceIsTheMotionToTheNextFrame) {
  last_.cam_from_world = Shift(3.0);
  Frame next;
  next.id = FrameId(2);
  next.timestamp = 0.5;
  const std::optional<CameraMotion> motion = MotionSince(last_, next, Shift(3.25));
  ASSERT_TRUE(motion);
  EXPECT_DOUBLE_EQ(motion->cam_from_last_cam.translation.x(), 0.25);
  EXPECT_DOUBLE_EQ(motion->duration, 0.5);
  next.id = FrameId(3);
  EXPECT_FALSE(MotionSince(last_, next, Shift(3.25))) << "a frame in between was lost";
  EXPECT_FALSE(MotionSince(LastFrame(), next, Shift(3.25)));
}

// The last frame is at 0 s, and the camera moved 0.4 m in the 0.1 s before it.
TEST_F(LastFrameTest, ThePredictedMotionIsProportionalToTheTimeStep) {
  ASSERT_EQ(last_.frame->timestamp, 0.0);
  EXPECT_NEAR(PredictMotion(last_, 0.1)->translation.x(), 0.4, 1e-12);
  EXPECT_NEAR(PredictMotion(last_, 0.05)->translation.x(), 0.2, 1e-12);
  EXPECT_NEAR(PredictMotion(last_, 0.3)->translation.x(), 1.2, 1e-12);
}

TEST_F(LastFrameTest, NothingIsPredictedAfterALongGapOrWithoutAMotion) {
  EXPECT_TRUE(PredictMotion(last_, 0.399));
  EXPECT_FALSE(PredictMotion(last_, 0.401));
  last_.motion.reset();
  EXPECT_FALSE(PredictMotion(last_, 0.1));
}

TEST_F(LastFrameTest, TheMotionAgainstTheOrderOfTimeIsPredictedAlike) {
  last_.motion->duration = -0.1;
  EXPECT_NEAR(PredictMotion(last_, -0.1)->translation.x(), 0.4, 1e-12);
  EXPECT_NEAR(PredictMotion(last_, -0.3)->translation.x(), 1.2, 1e-12);
  EXPECT_FALSE(PredictMotion(last_, -0.401));
}

class ViewOverlap : public testing::Test {
 protected:
  // The pose of keyframe 0, turned to the side.
  Rigid3 Turned(double radians) const {
    return Rigid3(ExpSo3({0.0, radians, 0.0}), Eigen::Vector3d::Zero()) * keyframe_.cam_from_world;
  }
  double Share(double radians) const {
    return ShareInImage(made_.map, world_.sensor(), Turned(radians), keyframe_.landmarks);
  }

  const SyntheticWorld world_;
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 5});
  const Keyframe& keyframe_ = made_.map.keyframes().At(KeyframeId(0));
};

TEST_F(ViewOverlap, IsTheShareOfTheLandmarksInTheImage) {
  EXPECT_EQ(Share(0.0), 1.0);
  EXPECT_GT(Share(0.1), Share(0.2));
  EXPECT_NEAR(Share(0.2), Share(-0.2), 0.1);
  EXPECT_EQ(Share(3.14), 0.0) << "they are behind the camera";
}

TEST_F(ViewOverlap, IdsWithoutLandmarkAreLeftOut) {
  const std::vector<LandmarkId> none = {LandmarkId(), LandmarkId(1000000)};
  EXPECT_EQ(ShareInImage(made_.map, world_.sensor(), Turned(0.0), none), 1.0);
}

TEST_F(ViewOverlap, AnotherMotionLosesAsMuchAgain) {
  LastFrame last;
  last.landmarks = keyframe_.landmarks;
  const auto next = [&](double radians) {
    return NextOverlap(made_.map, world_.sensor(), Turned(radians), KeyframeId(0), last);
  };
  EXPECT_EQ(next(0.0), 1.0) << "a camera that stands still loses nothing";
  EXPECT_DOUBLE_EQ(next(0.2), 2.0 * Share(0.2) - 1.0);
  last.landmarks.clear();
  EXPECT_DOUBLE_EQ(next(0.2), Share(0.2)) << "the motion is not known";
}

TEST_F(LastFrameTest, TheOdometryKeepsItsUnitOfLength) {
  map_.MutableKeyframe(keyframe_).scale = 0.25;
  last_.map_per_odometry = 2.0;
  const LastFrame followed = FollowMap(map_, last_);
  EXPECT_DOUBLE_EQ(followed.map_per_odometry, 0.5);
  EXPECT_DOUBLE_EQ(FollowMap(map_, followed).map_per_odometry, 0.5) << "it is counted once";
}

TEST_F(LastFrameTest, PriorsOfSuccessiveFramesAddUp) {
  Frame frame = *MakeFrame(2, 1);
  frame.motion.reset();
  EXPECT_FALSE(MotionAhead(last_, frame).has_value()) << "no prior";
  frame.motion = MotionPrior{Shift(0.2), 0.1};
  last_.ahead = MotionAhead(last_, frame);
  EXPECT_DOUBLE_EQ(last_.ahead->cam_from_last_cam.translation.x(), 0.2);
  Frame next = *MakeFrame(3, 1);
  next.motion = MotionPrior{Shift(0.3), 0.2};
  const std::optional<MotionPrior> both = MotionAhead(last_, next);
  EXPECT_DOUBLE_EQ(both->cam_from_last_cam.translation.x(), 0.5);
  EXPECT_DOUBLE_EQ(both->covariance(0, 0), 2.0);
  EXPECT_DOUBLE_EQ(both->covariance(4, 4), 2.0 + 0.3 * 0.3) << "the turn moves the second step";
  last_.ahead.reset();
  EXPECT_FALSE(MotionAhead(last_, next).has_value()) << "a frame is missing";
}

}  // namespace

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/comparison/orb_slam2_keyframe_rule.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

KeyframePolicy Policy(bool has_depth = true) {
  KeyframePolicy policy;
  policy.rule = KeyframeRule::kOrbSlam2;
  policy.has_depth = has_depth;
  policy.time_tolerance = 0.5 / 30.0;
  policy.min_time_between = 0.2;
  return policy;
}

// Half a second after the last keyframe, with all landmarks of the reference keyframe.
KeyframeEvidence Strong() {
  return {.time_since_keyframe = 0.5,
          .inliers = 200,
          .reference_landmarks = 200,
          .close_tracked = 150,
          .close_untracked = 20,
          .keyframes = 5};
}

TEST(OrbSlam2KeyframeRule, AFrameIsDueBelowTheShareOfTheReferenceLandmarks) {
  KeyframeEvidence evidence = Strong();
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  evidence.inliers = 150;
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  evidence.inliers = 149;
  EXPECT_TRUE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
}

TEST(OrbSlam2KeyframeRule, WithoutDepthNineTenthsCountAndOneKeyframeIsNoException) {
  KeyframeEvidence evidence = Strong();
  evidence.keyframes = 1;
  evidence.inliers = 180;
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy(false)));
  evidence.inliers = 179;
  EXPECT_TRUE(NeedsKeyframeByOrbSlam2(evidence, Policy(false)));
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy(true)));
  evidence.inliers = 79;
  EXPECT_TRUE(NeedsKeyframeByOrbSlam2(evidence, Policy(true)));
}

TEST(OrbSlam2KeyframeRule, WithDepthTwoKeyframesAreNoException) {
  KeyframeEvidence evidence = Strong();
  evidence.inliers = 149;
  evidence.keyframes = 2;
  EXPECT_TRUE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  evidence.keyframes = 1;
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
}

TEST(OrbSlam2KeyframeRule, MissingClosePointsAreAReasonOnlyWithDepth) {
  KeyframeEvidence evidence = Strong();
  evidence.close_tracked = 99;
  evidence.close_untracked = 71;
  EXPECT_TRUE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy(false)));
  evidence.time_since_keyframe = 0.05;  // they are urgent
  EXPECT_TRUE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
}

TEST(OrbSlam2KeyframeRule, ABusyMapperGetsOnlyUrgentKeyframesWithDepth) {
  KeyframeEvidence evidence = Strong();
  evidence.inliers = 100;
  evidence.time_since_keyframe = 0.1;  // the mapper is still at the last keyframe
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  evidence.inliers = 49;
  EXPECT_TRUE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy(false)));
  evidence.requests_waiting = 3;
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
}

TEST(OrbSlam2KeyframeRule, AfterASecondABusyMapperIsAskedOnlyWithDepth) {
  KeyframeEvidence evidence = Strong();
  evidence.inliers = 100;
  evidence.mapper_is_idle = false;
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  evidence.time_since_keyframe = 1.0;
  EXPECT_TRUE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy(false)));
}

TEST(OrbSlam2KeyframeRule, AFrameNeedsMoreThanTheLeastLandmarks) {
  KeyframeEvidence evidence = Strong();
  evidence.inliers = Policy().min_landmarks;
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  ++evidence.inliers;
  EXPECT_TRUE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
}

TEST(OrbSlam2KeyframeRule, ALargeMapGetsNoKeyframeRightAfterARelocalisation) {
  KeyframeEvidence evidence = Strong();
  evidence.inliers = 100;
  evidence.time_since_relocalisation = 0.5;
  EXPECT_TRUE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  evidence.keyframes = 31;
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  evidence.time_since_relocalisation = 1.0;
  EXPECT_TRUE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
}

TEST(OrbSlam2KeyframeRule, ObjectsAreNoReason) {
  KeyframeEvidence evidence = Strong();
  evidence.unknown_objects = 3;
  EXPECT_FALSE(NeedsKeyframeByOrbSlam2(evidence, Policy()));
  EXPECT_FALSE(Policy().NeedsKeyframe(evidence));
  EXPECT_FALSE(Policy().NeedsKeyframeForObjects(evidence));
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/keyframe.h"

#include <gtest/gtest.h>

#include "hullslam/map/map.h"
#include "hullslam/util/check.h"
#include "map/keyframe_graph.h"
#include "map/made_map.h"
#include "support/pose_distance.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

Rigid3 AlongX(double x) { return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0.0, 0.0)}; }

TEST(RelativePose, HasNoReferenceAtFirst) {
  const RelativePose pose;
  EXPECT_FALSE(pose.reference.IsValid());
  EXPECT_EQ(pose.reference_scale, 1.0);
  EXPECT_THROW(Map().CamFromWorld(pose), CheckError);
}

TEST(RelativePose, ReturnsThePoseThatItWasMadeFrom) {
  RandomGeometry random(1);
  Map map;
  const KeyframeId reference = AddKeyframe(map, 1, 0, random.Pose(2.0, 3.0));
  map.MutableKeyframe(reference).scale = 1.7;
  const Rigid3 cam_from_world = random.Pose(2.0, 3.0);
  const RelativePose pose = map.RelativeTo(reference, cam_from_world);
  EXPECT_EQ(pose.reference, reference);
  EXPECT_EQ(pose.reference_scale, 1.7);
  EXPECT_LT(Distance(map.CamFromWorld(pose), cam_from_world), 1e-12);
}

TEST(RelativePose, FollowsItsReference) {
  RandomGeometry random(2);
  Map map;
  const KeyframeId reference = AddKeyframe(map, 1, 0, random.Pose(2.0, 3.0));
  const RelativePose pose = map.RelativeTo(reference, random.Pose(2.0, 3.0));
  const Rigid3 moved = random.Pose(2.0, 3.0);
  map.SetPose(reference, moved);
  EXPECT_LT(Distance(map.CamFromWorld(pose), pose.cam_from_reference * moved), 1e-12);
}

TEST(RelativePose, FollowsTheScaleOfItsReference) {
  Map map;
  const KeyframeId reference = AddKeyframe(map, 1, 0, AlongX(1.0));
  map.MutableKeyframe(reference).scale = 2.0;
  const RelativePose pose = map.RelativeTo(reference, AlongX(4.0));
  EXPECT_EQ(pose.cam_from_reference.translation.x(), 3.0);
  map.MutableKeyframe(reference).scale = 6.0;
  EXPECT_EQ(map.CamFromWorld(pose).translation.x(), 1.0 + 3.0 * (6.0 / 2.0));
}

TEST(RelativePose, FollowsTheScaleThroughACulledReference) {
  Map map;
  const KeyframeId parent = AddKeyframe(map, 1, 0, AlongX(1.0));
  const KeyframeId reference = AddKeyframe(map, 1, 0, AlongX(3.0));
  SetParent(map, reference, parent);
  map.MutableKeyframe(parent).scale = 2.0;
  map.MutableKeyframe(reference).scale = 4.0;
  const RelativePose pose = map.RelativeTo(reference, AlongX(8.0));
  map.CullKeyframe(reference);
  EXPECT_EQ(map.CamFromWorld(pose).translation.x(), 8.0);
  map.MutableKeyframe(parent).scale = 6.0;  // three times as much
  EXPECT_EQ(map.CamFromWorld(reference).translation.x(), 1.0 + 3.0 * 2.0);
  EXPECT_EQ(map.CamFromWorld(pose).translation.x(), 1.0 + 3.0 * 2.0 + 3.0 * 5.0);
  // A pose that is made now remembers the scale that the culled keyframe has now.
  const RelativePose later = map.RelativeTo(reference, AlongX(40.0));
  EXPECT_EQ(later.reference_scale, 12.0);
  EXPECT_EQ(map.CamFromWorld(later).translation.x(), 40.0);
}

TEST(Keyframe, HasNoLinksAtFirst) {
  const Keyframe keyframe;
  EXPECT_EQ(keyframe.frame, nullptr);
  EXPECT_FALSE(keyframe.parent.IsValid());
  EXPECT_TRUE(keyframe.children.empty());
  EXPECT_TRUE(keyframe.covisible.empty());
  EXPECT_FALSE(Covisible().keyframe.IsValid());
  EXPECT_TRUE(keyframe.loops.empty());
  EXPECT_EQ(keyframe.scale, 1.0);
  EXPECT_FALSE(CulledKeyframe().pose.reference.IsValid());
  EXPECT_EQ(CulledKeyframe().scale, 1.0);
}

// The features of an image are large; copying a keyframe, as snapshots do, must not copy them.
TEST(Keyframe, CopiesShareTheirFrame) {
  Keyframe keyframe;
  keyframe.frame = MakeFrame(1, 10);
  const Keyframe copy = keyframe;
  EXPECT_EQ(copy.frame.get(), keyframe.frame.get());
}

}  // namespace

}  // namespace hullslam

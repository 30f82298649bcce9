// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

class LiveMapTest : public ::testing::Test {
 protected:
  // Each keyframe has a frame of its own.
  std::shared_ptr<const Frame> AsNextFrame(const std::shared_ptr<const Frame>& frame) const {
    auto next = std::make_shared<Frame>(*frame);
    next->id = made_.map.NextFrame();
    return next;
  }

  SyntheticWorld world_;
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 10, 20});
};

TEST_F(LiveMapTest, FollowsLandmarksKeyframesAndEdges) {
  LiveMap live(world_.sensor(), 0.0, {});
  const LiveMapChange change = live.Follow(made_.map, false);
  EXPECT_EQ(change.landmarks.count, made_.map.landmarks().size());
  EXPECT_EQ(change.keyframes.ids, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_TRUE(change.were_edges_changed);
  const auto& [id, landmark] = *made_.map.landmarks().begin();
  EXPECT_EQ(live.landmarks().ids()[0], id.value);
  EXPECT_EQ(live.landmarks().values()[2], static_cast<float>(landmark.position.z()));
  EXPECT_EQ(live.landmark_total(), made_.map.landmarks().size());
  const LiveMapChange next = live.Follow(made_.map, true);
  EXPECT_TRUE(next.landmarks.empty());
  EXPECT_TRUE(next.keyframes.empty());
  EXPECT_FALSE(next.were_edges_changed);
}

TEST_F(LiveMapTest, SendsWhatMovesAndWhatIsGone) {
  LiveMap live(world_.sensor(), 0.0, {});
  live.Follow(made_.map, false);
  const LandmarkId first = (*made_.map.landmarks().begin()).first;
  const LandmarkId second = LandmarkId(first.value + 1);
  made_.map.SetPosition(first,
                        made_.map.landmarks().At(first).position + Eigen::Vector3d(1e-5, 0.0, 0.0));
  EXPECT_TRUE(live.Follow(made_.map, true).landmarks.empty());  // too little to be seen
  made_.map.SetPosition(first,
                        made_.map.landmarks().At(first).position + Eigen::Vector3d(0.1, 0.0, 0.0));
  made_.map.EraseLandmark(second);
  const LiveMapChange change = live.Follow(made_.map, true);
  EXPECT_EQ(change.landmarks.count, made_.map.landmarks().size());
  EXPECT_EQ(std::ranges::count(change.landmarks.ids, first.value), 1);
  EXPECT_FALSE(live.landmarks().Contains(second.value));
}

// Landmarks at the other end of a long map do not make the rest of it coarse.
TEST_F(LiveMapTest, WhatCanBeSeenDoesNotDependOnTheSizeOfTheMap) {
  const Rigid3 far_away(Eigen::Quaterniond::Identity(), {5000.0, 0.0, 0.0});
  const SyntheticView& view = made_.views[0];
  const KeyframeId keyframe = made_.map.AddKeyframe(AsNextFrame(view.frame), far_away);
  for (uint32_t keypoint = 0; keypoint < view.points.size(); ++keypoint) {
    const LandmarkId landmark =
        made_.map.AddLandmark(Inverse(far_away) * world_.points()[view.points[keypoint]], keyframe);
    made_.map.AddObservation(landmark, keyframe, keypoint);
  }
  LiveMap live(world_.sensor(), 0.0, {});
  live.Follow(made_.map, false);
  const LandmarkId first = (*made_.map.landmarks().begin()).first;
  made_.map.SetPosition(first,
                        made_.map.landmarks().At(first).position + Eigen::Vector3d(0.05, 0.0, 0.0));
  EXPECT_EQ(live.Follow(made_.map, true).landmarks.ids, std::vector<uint32_t>{first.value});
}

TEST_F(LiveMapTest, LargeMapsAreThinnedEvenlyAndStayBelowTheLimit) {
  const size_t most = made_.map.landmarks().size() / 3;
  LiveMap live(world_.sensor(), 0.0, {.landmarks = most, .covisibility = 1});
  live.Follow(made_.map, false);
  EXPECT_LE(live.landmarks().size(), most + most / 3);
  EXPECT_GE(live.landmarks().size(), most / 3);
  EXPECT_LE(live.edges().covisibility.size(), 1u);
  EXPECT_EQ(live.landmark_total(), made_.map.landmarks().size());
}

TEST_F(LiveMapTest, OfManyObjectsThoseThatWereSeenLastAreShown) {
  constexpr uint32_t kViews = 3;
  Map map;
  for (uint32_t number = 0; number < kViews; ++number) {
    auto frame = std::make_shared<Frame>(*made_.views[number].frame);
    frame->detections.assign(4, Detection());
    const KeyframeId keyframe = map.AddKeyframe(frame, Rigid3());
    for (uint32_t detection = 0; detection < 4; ++detection) {
      const ObjectId id = map.AddObject();
      map.MutableObject(id).has_shape = true;
      map.AddObservation(id, keyframe, detection);
      map.MutableObject(id).reference = keyframe;
    }
  }
  LiveMap few(world_.sensor(), 0.0, {.objects = 5});
  few.Follow(map, false);
  EXPECT_TRUE(few.IsThinned());
  EXPECT_EQ(few.objects().size(), 8u);  // all of the keyframe of the fifth one
  EXPECT_EQ(few.objects().begin()->first, ObjectId(4));
  LiveMap all(world_.sensor(), 0.0, {.objects = 10});
  EXPECT_EQ(all.Follow(map, false).objects.size(), 12u);
  EXPECT_FALSE(all.IsThinned());
  map.EraseObject(ObjectId(3));
  const LiveMapChange change = all.Follow(map, true);
  EXPECT_TRUE(change.were_objects_removed);
  EXPECT_TRUE(change.objects.empty());
}

TEST_F(LiveMapTest, AChangeIsLimited) {
  LiveMap live(world_.sensor(), 0.0, {.changed_landmarks = 10, .changed_keyframes = 1});
  EXPECT_EQ(live.Follow(made_.map, true).landmarks.at.size(), 10u);
  EXPECT_EQ(live.Follow(made_.map, true).landmarks.count, 20u);
  EXPECT_EQ(live.keyframes().size(), 2u);
  live.Follow(made_.map, false);
  EXPECT_EQ(live.landmarks().size(), made_.map.landmarks().size());
}

TEST_F(LiveMapTest, OnlyTheMainIslandIsShown) {
  const IslandId island = made_.map.BeginIsland();
  made_.map.AddKeyframe(AsNextFrame(made_.views[0].frame), Rigid3(), island);
  LiveMap live(world_.sensor(), 0.0, {});
  live.Follow(made_.map, false);
  EXPECT_EQ(live.keyframes().size(), 3u);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "places/landmark_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "frame/measure_point.h"
#include "map/keyframe_graph.h"
#include "support/random_geometry.h"
#include "support/ring_world.h"

namespace hullslam {
namespace {

// A map of the ring world without drift. `view_` is a new frame between the keyframes 4 and 5, and
// `asked_` are the landmarks of the keyframes 2 to 6.
class LandmarkSearch : public testing::Test {
 protected:
  static constexpr double kTurns = 4.3 / 24.0;

  LandmarkSearch() {
    for (uint32_t i = 2; i <= 6; ++i) {
      place_.emplace_back(i);
    }
    asked_ = ObservedLandmarks(made_.map, place_);
  }
  std::vector<FoundLandmark> Find(const Rigid3& cam_from_world) const {
    return FindLandmarks(made_.map, world_.sensor(), *view_.frame, cam_from_world, asked_);
  }
  // The index of the point of the world that is this landmark.
  uint32_t PointOf(LandmarkId id) const {
    const Observation& observation = made_.map.landmarks().At(id).observations.front();
    return made_.views[observation.keyframe.value].points[observation.keypoint];
  }
  size_t CountRight(const std::vector<FoundLandmark>& found) const {
    return static_cast<size_t>(std::count_if(found.begin(), found.end(), [&](const auto& one) {
      return PointOf(one.landmark) == view_.points[one.keypoint];
    }));
  }
  void ExpectUnique(const std::vector<FoundLandmark>& found) const {
    std::set<uint32_t> keypoints;
    std::set<LandmarkId> landmarks;
    for (const auto& [keypoint, landmark] : found) {
      EXPECT_TRUE(keypoints.insert(keypoint).second) << keypoint;
      EXPECT_TRUE(landmarks.insert(landmark).second) << landmark.value;
    }
  }

  const RingWorld& world_ = SharedRing();
  const RingMap made_ = MakeRingMap(world_, {.drift = Rigid3()});
  const Rigid3 pose_ = RingWorld::CamFromWorld(kTurns);
  const SyntheticView view_ = world_.Observe(FrameId(1000), pose_);
  std::vector<KeyframeId> place_;
  std::vector<LandmarkId> asked_;
};

TEST_F(LandmarkSearch, FindsNearlyAllFromTheRightPoseAndNoneWrongly) {
  const std::vector<FoundLandmark> found = Find(pose_);
  ExpectUnique(found);
  size_t in_view = 0;
  for (const LandmarkId id : asked_) {
    in_view += std::count(view_.points.begin(), view_.points.end(), PointOf(id)) > 0 ? 1 : 0;
  }
  EXPECT_GT(in_view, 150u);
  EXPECT_GT(found.size(), in_view * 9 / 10);
  EXPECT_EQ(CountRight(found), found.size());
}

TEST_F(LandmarkSearch, FoundLandmarksAgreeWithTheirKeypoints) {
  RandomGeometry random(1);
  size_t count = 0;
  for (int run = 0; run < 20; ++run) {
    const Rigid3 pose = random.Pose(0.005, 0.01) * pose_;
    for (const auto& [keypoint, landmark] : Find(pose)) {
      EXPECT_TRUE(IsInlier(world_.sensor().camera,
                           MeasurePoint(world_.sensor(), view_.frame->features, keypoint,
                                        world_.sensor().depth_error),
                           pose * made_.map.landmarks().At(landmark).position));
      ++count;
    }
  }
  EXPECT_GT(count, 100u);
}

TEST_F(LandmarkSearch, FindsNothingFromAWrongPose) {
  EXPECT_TRUE(Find(RingWorld::CamFromWorld(kTurns + 0.5)).empty());
  EXPECT_LT(Find(RingWorld::CamFromWorld(kTurns + 0.05)).size(), 5u);
}

TEST_F(LandmarkSearch, FindsOnlyLandmarksThatItIsGiven) {
  const std::vector<FoundLandmark> all = Find(pose_);
  asked_ = {all[3].landmark, all[8].landmark};
  std::sort(asked_.begin(), asked_.end());
  const std::vector<FoundLandmark> two = Find(pose_);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(CountRight(two), 2u);
  asked_.clear();
  EXPECT_TRUE(Find(pose_).empty());
}

class LandmarkWords : public LandmarkSearch {
 protected:
  std::vector<FoundLandmark> Match(const std::vector<uint8_t>& is_asked = {}) const {
    return MatchLandmarksByWords(made_.map, *view_.frame, KeyframeId(4), is_asked);
  }
};

TEST_F(LandmarkWords, MatchesLandmarksOfTheKeyframeWithoutAPose) {
  const std::vector<FoundLandmark> found = Match();
  ExpectUnique(found);
  const std::vector<LandmarkId>& known = made_.map.keyframes().At(KeyframeId(4)).landmarks;
  for (const FoundLandmark& one : found) {
    EXPECT_EQ(std::count(known.begin(), known.end(), one.landmark), 1);
  }
  EXPECT_GT(found.size(), 100u);
  EXPECT_GT(CountRight(found), found.size() * 19 / 20);
}

TEST_F(LandmarkWords, LeavesOutKeypointsThatAreNotAskedFor) {
  const size_t keypoints = view_.frame->features.size();
  std::vector<uint8_t> is_asked(keypoints, 1);
  const std::vector<FoundLandmark> all = Match();
  EXPECT_EQ(Match(is_asked).size(), all.size());
  for (size_t i = 0; i < keypoints; i += 2) {
    is_asked[i] = 0;
  }
  const std::vector<FoundLandmark> odd = Match(is_asked);
  EXPECT_GT(odd.size(), 50u);
  for (const FoundLandmark& one : odd) {
    EXPECT_EQ(one.keypoint % 2, 1u);
  }
  EXPECT_TRUE(Match(std::vector<uint8_t>(keypoints, 0)).empty());
}

TEST_F(LandmarkWords, MatchesNothingOfAnotherPlace) {
  EXPECT_LT(MatchLandmarksByWords(made_.map, *view_.frame, KeyframeId(16), {}).size(), 5u);
}

class WideMatches : public testing::TestWithParam<bool> {
 protected:
  const RingWorld& world_ = SharedRing();
  RingMap made_ =
      MakeRingMap(world_, {.keyframes = 24, .drift = Rigid3(), .has_vocabulary = GetParam()});
};

INSTANTIATE_TEST_SUITE_P(Vocabulary, WideMatches, testing::Bool());

// Keyframe k is frame 3 k.
TEST_P(WideMatches, KeyframesNearInTimeComeFirst) {
  const SyntheticView view = world_.Observe(FrameId(31), RingWorld::CamFromWorld(0.0));
  const std::vector<KeyframeId> keyframes = KeyframesForWideMatches(made_.map, *view.frame);
  ASSERT_GE(keyframes.size(), 10u);
  EXPECT_EQ(std::vector(keyframes.begin(), keyframes.begin() + 4),
            (std::vector{KeyframeId(10), KeyframeId(11), KeyframeId(9), KeyframeId(12)}));
  EXPECT_EQ(std::set(keyframes.begin(), keyframes.end()).size(), keyframes.size());
  const bool has_similar =
      std::find(keyframes.begin(), keyframes.end(), KeyframeId(0)) != keyframes.end();
  EXPECT_EQ(has_similar, GetParam()) << "only words tell of it";
}

TEST_P(WideMatches, KeyframesOfAnIslandCanBeLeftOut) {
  const IslandId other = made_.map.BeginIsland();
  made_.map.MoveToIsland(KeyframeId(11), other);
  const SyntheticView view = world_.Observe(FrameId(31), RingWorld::CamFromWorld(0.0));
  EXPECT_EQ(KeyframesForWideMatches(made_.map, *view.frame,
                                    made_.map.keyframes().At(KeyframeId(0)).island),
            std::vector{KeyframeId(11)});
}

// 40 degrees and 0.55 m away.
TEST_P(WideMatches, LandmarksAreFoundWhereverTheyAreInTheImage) {
  const SyntheticView view = world_.Observe(FrameId(1000), RingWorld::CamFromWorld(8.7 / 24.0));
  const std::vector<FoundLandmark> found = MatchLandmarksOf(made_.map, *view.frame, KeyframeId(6));
  EXPECT_GT(found.size(), 20u);
  for (const auto& [keypoint, landmark] : found) {
    const Observation& seen = made_.map.landmarks().At(landmark).observations.front();
    EXPECT_EQ(made_.views[seen.keyframe.value].points[seen.keypoint], view.points[keypoint]);
  }
  EXPECT_TRUE(MatchLandmarksOf(made_.map, *view.frame, KeyframeId(20)).empty());
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_candidates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "loop/ring_things.h"
#include "map/correction.h"
#include "map/keyframe_graph.h"
#include "map_files/invariants.h"
#include "places/made_places.h"
#include "support/ring_world.h"

namespace hullslam {
namespace {

using Ids = std::vector<KeyframeId>;

Ids Find(const Map& map, KeyframeId query) {
  Ids ids;
  for (const LoopCandidate& candidate : FindLoopCandidates(map, query)) {
    ids.push_back(candidate.keyframe);
  }
  return ids;
}

bool AreCovisible(const Map& map, KeyframeId a, KeyframeId b) {
  const std::vector<Covisible>& covisible = map.keyframes().At(a).covisible;
  return std::any_of(covisible.begin(), covisible.end(),
                     [&](const Covisible& other) { return other.keyframe == b; });
}

bool AreNear(const Map& map, KeyframeId a, KeyframeId b) {
  const std::vector<Covisible>& covisible = map.keyframes().At(a).covisible;
  return a == b || AreCovisible(map, a, b) ||
         std::any_of(covisible.begin(), covisible.end(),
                     [&](const Covisible& other) { return AreCovisible(map, other.keyframe, b); });
}

TEST(LoopCandidates, AreAtThePlaceThatIsSeenAgain) {
  const RingMap made = MakeRingMap(SharedRing());
  const std::vector<LoopCandidate> candidates = FindLoopCandidates(made.map, made.last());
  ASSERT_FALSE(candidates.empty());
  EXPECT_EQ(candidates.front().keyframe, KeyframeId(made.last().value - 24)) << "one turn before";
  EXPECT_GE(candidates.front().supporters, 2);
}

TEST(LoopCandidates, AreNeitherConnectedWithTheQueryNorWithEachOther) {
  const RingMap made = MakeRingMap(SharedRing());
  size_t count = 0;
  for (const auto& [id, keyframe] : made.map.keyframes()) {
    const Ids candidates = Find(made.map, id);
    for (const KeyframeId candidate : candidates) {
      EXPECT_FALSE(AreNear(made.map, id, candidate)) << id.value << ' ' << candidate.value;
      for (const KeyframeId other : candidates) {
        EXPECT_FALSE(AreCovisible(made.map, candidate, other));
      }
      ++count;
    }
  }
  EXPECT_GE(count, 6u);
}

TEST(LoopCandidates, APlaceThatIsSeenOnceHasNone) {
  const RingMap made = MakeRingMap(SharedRing());
  for (uint32_t i = 9; i < 18; ++i) {
    EXPECT_TRUE(Find(made.map, KeyframeId(i)).empty()) << i;
  }
}

// Keyframes of words: the query 4 with its neighbours 2 and 3, and the old keyframes 0 and 1.
class CandidatesByWords : public testing::Test {
 protected:
  void Add(const std::vector<std::vector<uint32_t>>& words) {
    for (const std::vector<uint32_t>& of_keyframe : words) {
      AddWords(map_, of_keyframe, 120);
    }
    Connect(map_, KeyframeId(0), KeyframeId(1));
    Connect(map_, KeyframeId(2), KeyframeId(3));
    Connect(map_, KeyframeId(2), KeyframeId(4));
    Connect(map_, KeyframeId(3), KeyframeId(4));
  }

  Map map_ = MakeWordMap();
};

TEST_F(CandidatesByWords, SupportersAreNeighboursThatLookLikeTheSamePlace) {
  // Keyframe 2 looks like the neighbour of the candidate. Keyframe 3 looks like no old keyframe.
  Add({{1, 2, 3, 4}, {5, 6, 7, 8}, {5, 6, 7, 30}, {30, 20, 21, 22}, {1, 2, 3, 30}});
  const std::vector<LoopCandidate> candidates = FindLoopCandidates(map_, KeyframeId(4));
  ASSERT_EQ(candidates.size(), 1u);
  EXPECT_EQ(candidates[0].keyframe, KeyframeId(0));
  EXPECT_EQ(candidates[0].supporters, 1);
}

TEST_F(CandidatesByWords, ACandidateIsAsSimilarAsTheQuerysOwnNeighbours) {
  // The query has two of its four words in common with keyframe 0, but three with each of its
  // neighbours.
  Add({{1, 2, 40, 41}, {42, 43, 44, 45}, {1, 2, 3, 30}, {1, 2, 4, 30}, {1, 2, 3, 4}});
  EXPECT_TRUE(Find(map_, KeyframeId(4)).empty());
}

TEST_F(CandidatesByWords, OneNeighbourThatIsLessSimilarIsEnough) {
  Add({{1, 2, 40, 41}, {42, 43, 44, 45}, {1, 2, 3, 30}, {1, 31, 32, 30}, {1, 2, 3, 4}});
  EXPECT_EQ(Find(map_, KeyframeId(4)), Ids{KeyframeId(0)});
}

TEST_F(CandidatesByWords, AQueryAloneInTheMapHasNone) {
  const KeyframeId alone = AddWords(map_, {1, 2, 3});
  EXPECT_TRUE(Find(map_, alone).empty());
}

constexpr size_t kMinLandmarks = 40;
constexpr uint32_t kPerTurn = 48;

// A ring without drift. Its last keyframe is at the place of the keyframe kBefore.
constexpr uint32_t kBefore = 9;

class ReturnToPlace : public testing::Test {
 protected:
  // Joins landmarks that the last keyframe and the one a turn earlier show, as tracking does when
  // it finds them. Returns their number, at most `most`.
  size_t FindAgain(size_t most) {
    Map& map = made_.map;
    const auto last = static_cast<uint32_t>(made_.views.size()) - 1;
    const std::vector<uint32_t>& now = made_.views[last].points;
    const std::vector<uint32_t>& before = made_.views[kBefore].points;
    size_t joined = 0;
    for (size_t i = 0; i < now.size() && joined < most; ++i) {
      const auto seen_at = std::find(before.begin(), before.end(), now[i]);
      if (seen_at == before.end()) {
        continue;
      }
      const LandmarkId own = map.keyframes().At(KeyframeId(last)).landmarks[i];
      const LandmarkId old = map.keyframes()
                                 .At(KeyframeId(kBefore))
                                 .landmarks[static_cast<size_t>(seen_at - before.begin())];
      if (own.IsValid() && old.IsValid() && own != old) {
        map.ReplaceLandmark(own, old);
        ++joined;
      }
    }
    UpdateCovisibility(map, made_.last());
    return joined;
  }
  std::optional<Return> Find() { return FindReturn(made_.map, made_.last(), kMinLandmarks); }

  RingMap made_ = MakeRingMap(
      SharedRing(),
      {.keyframes = kPerTurn + kBefore + 1, .keyframes_per_turn = kPerTurn, .drift = Rigid3()},
      ThreeThings());
};

TEST_F(ReturnToPlace, IsFoundWhereTrackingHasFoundEnoughLandmarksOfAnEarlierVisit) {
  EXPECT_FALSE(Find());
  ASSERT_EQ(FindAgain(kMinLandmarks / 2), kMinLandmarks / 2);
  EXPECT_FALSE(Find());
  ASSERT_EQ(FindAgain(kMinLandmarks), kMinLandmarks);
  const std::optional<Return> found = Find();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->query, made_.last());
  EXPECT_LT(found->candidate.value, 2 * kBefore);
  EXPECT_TRUE(std::is_sorted(found->present.begin(), found->present.end()));
  EXPECT_TRUE(std::is_sorted(found->earlier.begin(), found->earlier.end()));
  EXPECT_EQ(found->present.back(), made_.last());
  EXPECT_GT(found->present.front().value, kPerTurn / 2);
  EXPECT_LT(found->earlier.back().value, kPerTurn / 2);
}

TEST_F(ReturnToPlace, NeedsKeyframesFromElsewhere) {
  for (uint32_t i = 0; i < made_.views.size(); ++i) {
    EXPECT_FALSE(FindReturn(made_.map, KeyframeId(i), 0)) << i;
  }
}

// A camera that is found in a loaded map has not drifted on its way there.
TEST_F(ReturnToPlace, NeedsBothVisitsInOneSession) {
  const auto finds_at_new_keyframe = [&](bool begins_session) {
    Map map = made_.map.Snapshot();
    const FrameId frame(1000);
    if (begins_session) {
      map.BeginSession({"second", frame});
    }
    const Rigid3& pose = made_.true_cam_from_world[kBefore];
    const SyntheticView view = SharedRing().Observe(frame, pose);
    const KeyframeId keyframe = map.AddKeyframe(view.frame, pose);
    const std::vector<uint32_t>& before = made_.views[kBefore].points;
    for (size_t i = 0; i < before.size(); ++i) {
      const auto seen_at = std::find(view.points.begin(), view.points.end(), before[i]);
      const LandmarkId landmark = map.keyframes().At(KeyframeId(kBefore)).landmarks[i];
      if (seen_at != view.points.end() && landmark.IsValid()) {
        map.AddObservation(landmark, keyframe,
                           static_cast<uint32_t>(seen_at - view.points.begin()));
      }
    }
    UpdateCovisibility(map, keyframe);
    return FindReturn(map, keyframe, kMinLandmarks).has_value();
  };
  EXPECT_TRUE(finds_at_new_keyframe(false));
  EXPECT_FALSE(finds_at_new_keyframe(true));
}

TEST_F(ReturnToPlace, MergesDuplicatesAndMovesNothing) {
  FindAgain(kMinLandmarks);
  const std::optional<Return> found = Find();
  ASSERT_TRUE(found);
  const MapCorrection correction = JoinVisits(made_.map, SharedRing().sensor(), *found, {});
  Map map = made_.map.Snapshot();
  ASSERT_TRUE(ApplyCorrection(map, correction, SharedRing().sensor().levels).is_applied);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  EXPECT_LT(map.landmarks().size(), made_.map.landmarks().size() - 100);
  EXPECT_EQ(map.objects().size(), 3u);
  EXPECT_EQ(map.keyframes().At(made_.last()).loops.size(), 1u);
  for (uint32_t i = 0; i < made_.views.size(); ++i) {
    EXPECT_LT(PoseError(made_, map, KeyframeId(i)), 1e-12) << i;
  }
}

TEST_F(ReturnToPlace, IsFoundOnce) {
  FindAgain(kMinLandmarks);
  ASSERT_TRUE(Find());
  made_.map.AddLoop(Find()->candidate, made_.last());
  EXPECT_FALSE(Find());
}

}  // namespace

}  // namespace hullslam

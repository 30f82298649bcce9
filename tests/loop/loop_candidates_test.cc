// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_candidates.h"

#include <gtest/gtest.h>

#include <algorithm>

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

bool AreConnected(const Map& map, KeyframeId a, KeyframeId b) {
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
      EXPECT_FALSE(AreConnected(made.map, id, candidate)) << id.value << ' ' << candidate.value;
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

}  // namespace
}  // namespace hullslam

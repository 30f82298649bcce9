// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_candidates.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "places/made_places.h"
#include "support/ring_world.h"

namespace hullslam {
namespace {

using Ids = std::vector<KeyframeId>;

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
  const Ids candidates = FindLoopCandidates(made.map, made.last(), 2);
  ASSERT_FALSE(candidates.empty());
  EXPECT_EQ(candidates.front(), KeyframeId(made.last().value - 24)) << "one turn before";
}

TEST(LoopCandidates, AreNeitherConnectedWithTheQueryNorWithEachOther) {
  const RingMap made = MakeRingMap(SharedRing());
  size_t count = 0;
  made.map.keyframes().ForEach([&](KeyframeId id, const Keyframe&) {
    const Ids candidates = FindLoopCandidates(made.map, id, 0);
    for (const KeyframeId candidate : candidates) {
      EXPECT_FALSE(AreConnected(made.map, id, candidate)) << id.value << ' ' << candidate.value;
      for (const KeyframeId other : candidates) {
        EXPECT_FALSE(AreCovisible(made.map, candidate, other));
      }
      ++count;
    }
  });
  EXPECT_GE(count, 6u);
}

TEST(LoopCandidates, APlaceThatIsSeenOnceHasNone) {
  const RingMap made = MakeRingMap(SharedRing());
  for (uint32_t i = 9; i < 18; ++i) {
    EXPECT_TRUE(FindLoopCandidates(made.map, KeyframeId(i), 0).empty()) << i;
  }
}

TEST(LoopCandidates, AskingForMoreSupportersOnlyTakesCandidatesAway) {
  const RingMap made = MakeRingMap(SharedRing());
  for (uint32_t i = 24; i < 30; ++i) {
    Ids before = FindLoopCandidates(made.map, KeyframeId(i), 0);
    for (int supporters = 1; supporters <= 6; ++supporters) {
      const Ids now = FindLoopCandidates(made.map, KeyframeId(i), supporters);
      for (const KeyframeId candidate : now) {
        EXPECT_EQ(std::count(before.begin(), before.end(), candidate), 1);
      }
      before = now;
    }
    EXPECT_TRUE(before.empty()) << "only five keyframes are asked";
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
  Ids Find(int supporters) const { return FindLoopCandidates(map_, KeyframeId(4), supporters); }

  Map map_ = MakeWordMap();
};

TEST_F(CandidatesByWords, SupportersAreNeighboursThatLookLikeTheSamePlace) {
  // Keyframe 2 looks like the neighbour of the candidate, 3 like nothing old.
  Add({{1, 2, 3, 4}, {5, 6, 7, 8}, {5, 6, 7, 4}, {30, 20, 21, 22}, {1, 2, 3, 30}});
  EXPECT_EQ(Find(0), Ids{KeyframeId(0)});
  EXPECT_EQ(Find(1), Ids{KeyframeId(0)});
  EXPECT_TRUE(Find(2).empty());
}

TEST_F(CandidatesByWords, ACandidateIsAsSimilarAsTheQuerysOwnNeighbours) {
  // Two words of four are common with 0, but three with both of the neighbours.
  Add({{1, 2, 40, 41}, {42, 43, 44, 45}, {1, 2, 3, 30}, {1, 2, 4, 30}, {1, 2, 3, 4}});
  EXPECT_TRUE(Find(0).empty());
}

TEST_F(CandidatesByWords, AQueryAloneInTheMapHasNone) {
  const KeyframeId alone = AddWords(map_, {1, 2, 3});
  EXPECT_TRUE(FindLoopCandidates(map_, alone, 0).empty());
}

}  // namespace
}  // namespace hullslam

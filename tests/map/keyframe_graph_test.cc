// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/keyframe_graph.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "map/made_map.h"

namespace hullslam {
namespace {

// Keyframes 0 to 5: the root 0 has the child 1, which has the children 2 to 5.
class SpanningTree : public ::testing::Test {
 protected:
  SpanningTree() {
    for (int i = 0; i < 6; ++i) {
      AddKeyframe(map_, 200);
    }
    SetParent(map_, KeyframeId(1), KeyframeId(0));
    for (const uint32_t child : {5u, 3u, 2u, 4u}) {
      SetParent(map_, KeyframeId(child), KeyframeId(1));
    }
  }
  const Keyframe& At(uint32_t id) const { return map_.keyframes().At(KeyframeId(id)); }
  void ShareAndLink(uint32_t a, uint32_t b, int count) {
    Share(map_, KeyframeIds({a, b}), count);
    UpdateCovisibility(map_, KeyframeId(a));
  }
  Map map_;
};

TEST_F(SpanningTree, IsKnownAtBothEndsInOrder) {
  EXPECT_EQ(At(1).children, KeyframeIds({2, 3, 4, 5}));
  EXPECT_EQ(At(1).parent, KeyframeId(0));
  EXPECT_FALSE(At(0).parent.IsValid());
}

TEST_F(SpanningTree, ANewParentReplacesTheFormer) {
  SetParent(map_, KeyframeId(3), KeyframeId(5));
  EXPECT_EQ(At(3).parent, KeyframeId(5));
  EXPECT_EQ(At(5).children, KeyframeIds({3}));
  EXPECT_EQ(At(1).children, KeyframeIds({2, 4, 5}));
  SetParent(map_, KeyframeId(3), KeyframeId(5));  // no change
  EXPECT_EQ(At(5).children, KeyframeIds({3}));
  SetParent(map_, KeyframeId(3), KeyframeId());
  EXPECT_FALSE(At(3).parent.IsValid());
  EXPECT_TRUE(At(5).children.empty());
}

TEST_F(SpanningTree, ChildrenThatShareNothingGoToTheParent) {
  DetachFromTree(map_, KeyframeId(1));
  EXPECT_EQ(At(0).children, KeyframeIds({2, 3, 4, 5}));
  EXPECT_FALSE(At(1).parent.IsValid());
  EXPECT_TRUE(At(1).children.empty());
}

// Child 2 shares most landmarks with the parent, 3 with 2 (which has its new parent by then), and 4
// with 3. Child 5 shares none.
TEST_F(SpanningTree, ChildrenGoToTheKeyframesThatTheyShareMostWith) {
  ShareAndLink(2, 0, 40);
  ShareAndLink(3, 2, 60);
  ShareAndLink(3, 0, 20);
  ShareAndLink(4, 3, 30);
  DetachFromTree(map_, KeyframeId(1));
  EXPECT_EQ(At(0).children, KeyframeIds({2, 5}));
  EXPECT_EQ(At(2).children, KeyframeIds({3}));
  EXPECT_EQ(At(3).children, KeyframeIds({4}));
  EXPECT_EQ(At(5).parent, KeyframeId(0));
}

// Siblings that share landmarks only with each other must not form a cycle.
TEST_F(SpanningTree, ASiblingBecomesAParentOnlyWhenItHasANewParent) {
  ShareAndLink(3, 2, 60);
  ShareAndLink(5, 4, 50);
  DetachFromTree(map_, KeyframeId(1));
  EXPECT_EQ(At(0).children, KeyframeIds({2, 4}));
  EXPECT_EQ(At(2).children, KeyframeIds({3}));
  EXPECT_EQ(At(4).children, KeyframeIds({5}));
}

TEST_F(SpanningTree, ALeafIsRemoved) {
  DetachFromTree(map_, KeyframeId(4));
  EXPECT_EQ(At(1).children, KeyframeIds({2, 3, 5}));
  EXPECT_FALSE(At(4).parent.IsValid());
}

// The tree is 0 - 1 - {2, 3, 4, 5}.
TEST_F(SpanningTree, AKeyframeBecomesTheRoot) {
  MakeRoot(map_, KeyframeId(4));
  EXPECT_FALSE(At(4).parent.IsValid());
  EXPECT_EQ(At(4).children, KeyframeIds({1}));
  EXPECT_EQ(At(1).parent, KeyframeId(4));
  EXPECT_EQ(At(1).children, KeyframeIds({0, 2, 3, 5}));
  EXPECT_EQ(At(0).parent, KeyframeId(1));
  MakeRoot(map_, KeyframeId(4));
  EXPECT_EQ(At(4).children, KeyframeIds({1}));
}

using Edges = std::vector<std::pair<uint32_t, int>>;

Edges EdgesOf(const Map& map, KeyframeId id) {
  Edges edges;
  for (const Covisible& edge : map.keyframes().At(id).covisible) {
    edges.emplace_back(edge.keyframe.value, edge.shared);
  }
  return edges;
}

class Covisibility : public ::testing::Test {
 protected:
  Covisibility() {
    for (KeyframeId& id : ids_) {
      id = AddKeyframe(map_, 100);
    }
  }
  Map map_;
  std::array<KeyframeId, 4> ids_;
};

TEST_F(Covisibility, NeedsFifteenSharedLandmarks) {
  Share(map_, {ids_[3], ids_[0]}, 14);
  Share(map_, {ids_[3], ids_[1]}, 15);
  Share(map_, {ids_[3], ids_[2]}, 40);
  UpdateCovisibility(map_, ids_[3]);
  EXPECT_EQ(EdgesOf(map_, ids_[3]), (Edges{{1, 15}, {2, 40}}));
  EXPECT_EQ(EdgesOf(map_, ids_[0]), Edges());
  EXPECT_EQ(EdgesOf(map_, ids_[1]), (Edges{{3, 15}}));
  EXPECT_EQ(EdgesOf(map_, ids_[2]), (Edges{{3, 40}}));
}

TEST_F(Covisibility, KeepsTheBestEdgeIfNoneHasEnough) {
  Share(map_, {ids_[3], ids_[0]}, 3);
  Share(map_, {ids_[3], ids_[1]}, 14);
  UpdateCovisibility(map_, ids_[3]);
  EXPECT_EQ(EdgesOf(map_, ids_[3]), (Edges{{1, 14}}));
  EXPECT_EQ(EdgesOf(map_, ids_[1]), (Edges{{3, 14}}));
  EXPECT_EQ(EdgesOf(map_, ids_[0]), Edges());
}

TEST_F(Covisibility, WithoutSharedLandmarksHasNoEdge) {
  UpdateCovisibility(map_, ids_[3]);
  EXPECT_EQ(EdgesOf(map_, ids_[3]), Edges());
  EXPECT_FALSE(map_.keyframes().At(ids_[3]).parent.IsValid());
}

TEST_F(Covisibility, ChangesWithTheObservations) {
  const std::vector<LandmarkId> shared = Share(map_, {ids_[0], ids_[1], ids_[2]}, 20);
  UpdateCovisibility(map_, ids_[2]);
  EXPECT_EQ(EdgesOf(map_, ids_[2]), (Edges{{0, 20}, {1, 20}}));
  for (int i = 0; i < 10; ++i) {
    map_.EraseLandmark(shared[static_cast<size_t>(i)]);
  }
  Share(map_, {ids_[1], ids_[2]}, 7);
  UpdateCovisibility(map_, ids_[2]);
  EXPECT_EQ(EdgesOf(map_, ids_[2]), (Edges{{1, 17}}));
  EXPECT_EQ(EdgesOf(map_, ids_[0]), Edges());
  EXPECT_EQ(EdgesOf(map_, ids_[1]), (Edges{{2, 17}}));
}

TEST_F(Covisibility, ObservedLandmarksAreUniqueAndInOrder) {
  const std::vector<LandmarkId> first = Share(map_, {ids_[0], ids_[1]}, 3);
  const std::vector<LandmarkId> second = Share(map_, {ids_[1], ids_[2]}, 2);
  std::vector<LandmarkId> all = first;
  all.insert(all.end(), second.begin(), second.end());
  EXPECT_EQ(ObservedLandmarks(map_, std::vector{ids_[2], ids_[0]}), all);
  EXPECT_EQ(ObservedLandmarks(map_, std::vector{ids_[1]}), all);
  EXPECT_EQ(ObservedLandmarks(map_, std::vector{ids_[3]}), std::vector<LandmarkId>());
}

TEST_F(Covisibility, SetsTheParentOnlyOnce) {
  Share(map_, {ids_[3], ids_[0]}, 20);
  Share(map_, {ids_[3], ids_[1]}, 30);
  UpdateCovisibility(map_, ids_[3]);
  EXPECT_EQ(map_.keyframes().At(ids_[3]).parent, ids_[1]);
  EXPECT_EQ(map_.keyframes().At(ids_[1]).children, std::vector<KeyframeId>{ids_[3]});
  Share(map_, {ids_[3], ids_[2]}, 40);
  UpdateCovisibility(map_, ids_[3]);
  EXPECT_EQ(map_.keyframes().At(ids_[3]).parent, ids_[1]);
}

TEST_F(Covisibility, SetsTheParentAlsoByAWeakEdge) {
  Share(map_, {ids_[1], ids_[0]}, 2);
  UpdateCovisibility(map_, ids_[1]);
  EXPECT_EQ(map_.keyframes().At(ids_[1]).parent, ids_[0]);
}

// A younger parent could be a descendant of the keyframe. The tree would then have a cycle.
TEST_F(Covisibility, TheParentIsOlderEvenIfAYoungerKeyframeSharesMore) {
  Share(map_, {ids_[1], ids_[0]}, 15);
  Share(map_, {ids_[1], ids_[2]}, 50);
  UpdateCovisibility(map_, ids_[2]);
  UpdateCovisibility(map_, ids_[1]);
  EXPECT_EQ(map_.keyframes().At(ids_[2]).parent, ids_[1]);
  EXPECT_EQ(map_.keyframes().At(ids_[1]).parent, ids_[0]);
  UpdateCovisibility(map_, ids_[0]);
  EXPECT_FALSE(map_.keyframes().At(ids_[0]).parent.IsValid());
}

TEST_F(Covisibility, ConnectsOverOthersByFifteenLandmarks) {
  Share(map_, {ids_[0], ids_[1]}, 15);
  Share(map_, {ids_[1], ids_[2]}, 15);
  Share(map_, {ids_[2], ids_[3]}, 14);
  for (const KeyframeId id : ids_) {
    UpdateCovisibility(map_, id);
  }
  EXPECT_TRUE(AreConnected(map_, ids_[0], ids_[2]));
  EXPECT_FALSE(AreConnected(map_, ids_[0], ids_[3]));
  EXPECT_TRUE(AreConnected(map_, ids_[3], ids_[3]));
  EXPECT_FALSE(IsTied(map_, ids_[0])) << "it has no parent";
  EXPECT_FALSE(IsTied(map_, ids_[2]));
  EXPECT_TRUE(IsTied(map_, ids_[3]));
  const auto without_prior = std::make_shared<Frame>(*map_.keyframes().At(ids_[3]).frame);
  without_prior->motion.reset();
  map_.MutableKeyframe(ids_[3]).frame = without_prior;
  EXPECT_FALSE(IsTied(map_, ids_[3])) << "few landmarks are not the same as none";
}

TEST_F(Covisibility, DetachingRemovesBothEnds) {
  Share(map_, {ids_[0], ids_[1], ids_[2]}, 20);
  UpdateCovisibility(map_, ids_[1]);
  UpdateCovisibility(map_, ids_[2]);
  DetachCovisibility(map_, ids_[1]);
  EXPECT_EQ(EdgesOf(map_, ids_[1]), Edges());
  EXPECT_EQ(EdgesOf(map_, ids_[0]), (Edges{{2, 20}}));
  EXPECT_EQ(EdgesOf(map_, ids_[2]), (Edges{{0, 20}}));
}

TEST(BestCovisible, AreSortedByDecreasingNumberThenId) {
  Keyframe keyframe;
  keyframe.covisible = {
      {KeyframeId(1), 20}, {KeyframeId(3), 50}, {KeyframeId(4), 20}, {KeyframeId(8), 15}};
  const std::vector<KeyframeId> all = {KeyframeId(3), KeyframeId(4), KeyframeId(1), KeyframeId(8)};
  EXPECT_EQ(BestCovisible(keyframe, 10), all);
  EXPECT_EQ(BestCovisible(keyframe, 2), std::vector<KeyframeId>(all.begin(), all.begin() + 2));
  EXPECT_TRUE(BestCovisible(keyframe, 0).empty());
  EXPECT_TRUE(BestCovisible(Keyframe(), 5).empty());
}

}  // namespace

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/spanning_tree.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "map/covisibility.h"
#include "map/made_map.h"

namespace hullslam {
namespace {

std::vector<KeyframeId> Ids(const std::vector<uint32_t>& numbers) {
  std::vector<KeyframeId> ids;
  for (const uint32_t number : numbers) {
    ids.emplace_back(number);
  }
  return ids;
}

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
    Share(map_, Ids({a, b}), count);
    UpdateCovisibility(map_, KeyframeId(a));
  }
  Map map_;
};

TEST_F(SpanningTree, IsKnownAtBothEndsInOrder) {
  EXPECT_EQ(At(1).children, Ids({2, 3, 4, 5}));
  EXPECT_EQ(At(1).parent, KeyframeId(0));
  EXPECT_FALSE(At(0).parent.IsValid());
}

TEST_F(SpanningTree, ANewParentReplacesTheFormer) {
  SetParent(map_, KeyframeId(3), KeyframeId(5));
  EXPECT_EQ(At(3).parent, KeyframeId(5));
  EXPECT_EQ(At(5).children, Ids({3}));
  EXPECT_EQ(At(1).children, Ids({2, 4, 5}));
  SetParent(map_, KeyframeId(3), KeyframeId(5));  // no change
  EXPECT_EQ(At(5).children, Ids({3}));
  SetParent(map_, KeyframeId(3), KeyframeId());
  EXPECT_FALSE(At(3).parent.IsValid());
  EXPECT_TRUE(At(5).children.empty());
}

TEST_F(SpanningTree, ChildrenThatShareNothingGoToTheParent) {
  DetachFromTree(map_, KeyframeId(1));
  EXPECT_EQ(At(0).children, Ids({2, 3, 4, 5}));
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
  EXPECT_EQ(At(0).children, Ids({2, 5}));
  EXPECT_EQ(At(2).children, Ids({3}));
  EXPECT_EQ(At(3).children, Ids({4}));
  EXPECT_EQ(At(5).parent, KeyframeId(0));
}

// Siblings that share landmarks only with each other must not form a cycle.
TEST_F(SpanningTree, ASiblingBecomesAParentOnlyWhenItHasANewParent) {
  ShareAndLink(3, 2, 60);
  ShareAndLink(5, 4, 50);
  DetachFromTree(map_, KeyframeId(1));
  EXPECT_EQ(At(0).children, Ids({2, 4}));
  EXPECT_EQ(At(2).children, Ids({3}));
  EXPECT_EQ(At(4).children, Ids({5}));
}

TEST_F(SpanningTree, ALeafIsRemoved) {
  DetachFromTree(map_, KeyframeId(4));
  EXPECT_EQ(At(1).children, Ids({2, 3, 5}));
  EXPECT_FALSE(At(4).parent.IsValid());
}

// The tree is 0 - 1 - {2, 3, 4, 5}.
TEST_F(SpanningTree, AKeyframeBecomesTheRoot) {
  MakeRoot(map_, KeyframeId(4));
  EXPECT_FALSE(At(4).parent.IsValid());
  EXPECT_EQ(At(4).children, Ids({1}));
  EXPECT_EQ(At(1).parent, KeyframeId(4));
  EXPECT_EQ(At(1).children, Ids({0, 2, 3, 5}));
  EXPECT_EQ(At(0).parent, KeyframeId(1));
  MakeRoot(map_, KeyframeId(4));
  EXPECT_EQ(At(4).children, Ids({1}));
}

}  // namespace
}  // namespace hullslam

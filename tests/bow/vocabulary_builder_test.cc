// SPDX-License-Identifier: GPL-3.0-or-later
#include "bow/vocabulary_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <vector>

#include "hullslam/util/check.h"
#include "support/made_vocabulary.h"

namespace hullslam {
namespace {

TEST(VocabularyLayout, PartsFollowEachOther) {
  const VocabularyLayout layout(6, 4);
  EXPECT_EQ(layout.descriptors, 64u);
  EXPECT_EQ(layout.first_child, 64u + 6u * 32u);
  EXPECT_EQ(layout.first_word, layout.first_child + 7u * 4u);
  EXPECT_EQ(layout.weights, layout.first_word + 6u * 4u);
  EXPECT_EQ(layout.size, layout.weights + 4u * 4u);
}

TEST(HashVocabulary, DependsOnEveryByteButThoseOfTheHash) {
  std::vector<std::byte> bytes(100, std::byte{7});
  std::set<uint64_t> hashes = {HashVocabulary(bytes)};
  constexpr size_t kBegin = offsetof(VocabularyHeader, hash);
  for (size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] ^= std::byte{1};
    const bool is_new = hashes.insert(HashVocabulary(bytes)).second;
    EXPECT_EQ(is_new, i < kBegin || i >= kBegin + 8) << i;
    bytes[i] ^= std::byte{1};
  }
}

// The hashes are written to files, so they must never change.
TEST(HashVocabulary, IsTheSameOnEveryComputer) {
  const std::vector<std::byte> bytes(1000, std::byte{7});
  EXPECT_EQ(HashVocabulary(bytes), 2713604248797538611u);
}

TEST(IsPossibleWeight, IsFiniteAndNotNegative) {
  EXPECT_TRUE(IsPossibleWeight(0.0f));
  EXPECT_TRUE(IsPossibleWeight(kMostWordWeight));
  EXPECT_FALSE(IsPossibleWeight(-1e-6f));
  EXPECT_FALSE(IsPossibleWeight(1001.0f));
  EXPECT_FALSE(IsPossibleWeight(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_FALSE(IsPossibleWeight(std::numeric_limits<float>::infinity()));
}

// The root has the leaf 1, the inner node 2 with the leaves 4 and 5, and the leaf 3.
std::vector<TreeNode> UnevenTree() {
  return {{0, {1, 0, 0, 0}, 0.5f},
          {0, {2, 0, 0, 0}, 9.0f},
          {0, {3, 0, 0, 0}, 1.5f},
          {2, {4, 0, 0, 0}, 2.5f},
          {2, {5, 0, 0, 0}, 3.5f}};
}

template <typename Value>
std::vector<Value> Copy(std::span<const Value> values) {
  return {values.begin(), values.end()};
}

TEST(BuildVocabulary, WordsAreNumberedDepthFirstAndNodesByLevel) {
  const Vocabulary vocabulary = BuildVocabulary(3, 2, UnevenTree());
  EXPECT_EQ(vocabulary.node_count(), 6u);
  EXPECT_EQ(vocabulary.word_count(), 4u);
  EXPECT_EQ(Copy(vocabulary.first_child()), (std::vector<uint32_t>{1, 4, 4, 6, 6, 6, 6}));
  EXPECT_EQ(Copy(vocabulary.first_word()), (std::vector<uint32_t>{0, 0, 1, 3, 1, 2}));
  EXPECT_EQ(Copy(vocabulary.weights()), (std::vector<float>{0.5f, 2.5f, 3.5f, 1.5f}));
  for (uint64_t node = 0; node < 6; ++node) {
    EXPECT_EQ(vocabulary.descriptors()[node][0], node);
  }
}

// A tree has the same bits whether its nodes are listed level by level or depth first.
TEST(BuildVocabulary, TheOrderOfTheNodesDoesNotMatterExceptAmongSiblings) {
  std::vector<TreeNode> depth_first = UnevenTree();
  std::rotate(depth_first.begin() + 2, depth_first.begin() + 3, depth_first.end());
  const Vocabulary a = BuildVocabulary(3, 2, UnevenTree());
  const Vocabulary b = BuildVocabulary(3, 2, depth_first);
  EXPECT_EQ(a.hash(), b.hash());
  EXPECT_EQ(BytesOf(a), BytesOf(b));
}

TEST(BuildVocabulary, WrongTreesAreErrorsOfTheProgram) {
  EXPECT_THROW(BuildVocabulary(3, 2, {}), CheckError);
  EXPECT_THROW(BuildVocabulary(2, 2, UnevenTree()), CheckError);  // three children
  EXPECT_THROW(BuildVocabulary(3, 1, UnevenTree()), CheckError);  // two levels
  std::vector<TreeNode> forward = UnevenTree();
  forward[1].parent = 2;  // itself
  EXPECT_THROW(BuildVocabulary(3, 2, forward), CheckError);
  std::vector<TreeNode> negative = UnevenTree();
  negative[0].weight = -1.0f;
  EXPECT_THROW(BuildVocabulary(3, 2, negative), CheckError);
}

}  // namespace

}  // namespace hullslam

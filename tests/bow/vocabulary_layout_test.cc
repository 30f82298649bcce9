// SPDX-License-Identifier: GPL-3.0-or-later
#include "bow/vocabulary_layout.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <vector>

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

}  // namespace
}  // namespace hullslam

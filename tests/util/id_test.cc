// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/id.h"

#include <gtest/gtest.h>

#include <type_traits>
#include <unordered_set>

namespace hullslam {
namespace {

TEST(Id, IsInvalidByDefault) {
  EXPECT_FALSE(KeyframeId().IsValid());
  EXPECT_TRUE(KeyframeId(0).IsValid());
  EXPECT_EQ(KeyframeId(), KeyframeId(KeyframeId::kInvalid));
}

TEST(Id, ComparesByNumber) {
  EXPECT_EQ(LandmarkId(7), LandmarkId(7));
  EXPECT_NE(LandmarkId(7), LandmarkId(8));
  EXPECT_LT(LandmarkId(7), LandmarkId(8));
  EXPECT_LT(LandmarkId(4000000000u), LandmarkId()) << "the invalid id is above all others";
}

TEST(Id, OfARecycledKindHasASlotAndAGeneration) {
  const LandmarkId id(7, 3);
  EXPECT_EQ(id.slot(), 7u);
  EXPECT_EQ(id.generation(), 3u);
  EXPECT_NE(id, LandmarkId(7));
  EXPECT_EQ(LandmarkId(7).slot(), 7u);
  EXPECT_EQ(LandmarkId(7).generation(), 0u);
  EXPECT_EQ(LandmarkId(LandmarkId::kMaxSlot, LandmarkId::kMaxGeneration), LandmarkId());
  EXPECT_EQ(KeyframeId(4000000000u).slot(), 4000000000u) << "other ids are their own slots";
}

TEST(Id, OfARecycledKindIsOrderedBySlotThenGeneration) {
  EXPECT_LT(LandmarkId(7, 3), LandmarkId(8, 0));
  EXPECT_LT(LandmarkId(7, 200), LandmarkId(8, 3));
  EXPECT_LT(LandmarkId(7, 2), LandmarkId(7, 3));
  EXPECT_LT(LandmarkId(LandmarkId::kMaxSlot - 1, 255), LandmarkId());
  EXPECT_LT(KeyframeId(0x00000001), KeyframeId(0x01000000)) << "other ids by their numbers";
}

TEST(Id, DoesNotConvert) {
  EXPECT_FALSE((std::is_convertible_v<KeyframeId, LandmarkId>));
  EXPECT_FALSE((std::is_constructible_v<KeyframeId, LandmarkId>));
  EXPECT_FALSE((std::is_convertible_v<uint32_t, FrameId>));
}

TEST(Id, CanBeAKey) {
  std::unordered_set<FrameId> set;
  for (uint32_t i = 0; i < 100; ++i) {
    set.insert(FrameId(i % 10));
  }
  EXPECT_EQ(set.size(), 10u);
  EXPECT_TRUE(set.contains(FrameId(9)));
  EXPECT_FALSE(set.contains(FrameId(10)));
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/id_set.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace hullslam {
namespace {

TEST(IdSet, SaysWhetherAnIdIsNew) {
  IdSet<KeyframeId> set;
  EXPECT_FALSE(set.Contains(KeyframeId(3)));
  EXPECT_TRUE(set.Insert(KeyframeId(3)));
  EXPECT_FALSE(set.Insert(KeyframeId(3)));
  EXPECT_TRUE(set.Contains(KeyframeId(3)));
  EXPECT_FALSE(set.Contains(KeyframeId(4))) << "it only shares the group of 64 slots with members";
  EXPECT_FALSE(set.Contains(KeyframeId()));
  EXPECT_EQ(set.size(), 1u);
}

TEST(IdSet, SortsItsMembers) {
  std::mt19937 random(1);
  IdSet<LandmarkId> set;
  std::set<LandmarkId> model;
  for (int i = 0; i < 5000; ++i) {
    const auto slot = static_cast<uint32_t>(random()) % 20000;
    const LandmarkId id(slot, slot % 200);
    EXPECT_EQ(set.Insert(id), model.insert(id).second);
  }
  EXPECT_EQ(set.size(), model.size());
  EXPECT_EQ(set.Sorted(), std::vector<LandmarkId>(model.begin(), model.end()));
  EXPECT_TRUE(IdSet<LandmarkId>().Sorted().empty());
}

TEST(IdSet, DoesNotContainOtherGenerations) {
  IdSet<LandmarkId> set;
  set.Insert(LandmarkId(5, 2));
  EXPECT_TRUE(set.Contains(LandmarkId(5, 2)));
  EXPECT_FALSE(set.Contains(LandmarkId(5, 1)));
  EXPECT_THROW(set.Insert(LandmarkId(5, 1)), CheckError);
}

}  // namespace
}  // namespace hullslam

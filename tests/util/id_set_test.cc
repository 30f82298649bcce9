// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/id_set.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <vector>

#include "hullslam/util/id.h"

namespace hullslam {
namespace {

TEST(IdMap, FindsAddedValues) {
  IdMap<KeyframeId, int> map;
  EXPECT_EQ(map.Find(KeyframeId(3)), nullptr);
  ++map[KeyframeId(3)];
  ++map[KeyframeId(3)];
  map[KeyframeId()] = 7;
  EXPECT_EQ(*map.Find(KeyframeId(3)), 2);
  EXPECT_EQ(*map.Find(KeyframeId()), 7);
  EXPECT_EQ(map.Find(KeyframeId(4)), nullptr);
}

TEST(IdMap, AgreesWithAnOrderedMap) {
  std::mt19937 random(1);
  IdMap<LandmarkId, int> map;
  std::map<LandmarkId, int> model;
  for (int i = 0; i < 20000; ++i) {
    const LandmarkId id(static_cast<uint32_t>(random()) % 500, static_cast<uint32_t>(random()) % 9);
    map[id] += i;
    model[id] += i;
  }
  EXPECT_EQ(map.entries().size(), model.size());
  for (const auto& [id, value] : model) {
    ASSERT_NE(map.Find(id), nullptr);
    EXPECT_EQ(*map.Find(id), value);
  }
}

TEST(IdMap, KeepsTheOrderInWhichEntriesWereAdded) {
  IdMap<ObjectId, int> map;
  for (uint32_t i = 0; i < 300; ++i) {
    map[ObjectId(i * 7919 % 1000)] = static_cast<int>(i);
  }
  int expected = 0;
  for (const auto& [id, value] : map.entries()) {
    EXPECT_EQ(value, expected++);
  }
  EXPECT_EQ(expected, 300);
}

TEST(IdMap, IsEmptyAfterTake) {
  IdMap<ObjectId, int> map;
  for (uint32_t i = 0; i < 100; ++i) {
    map[ObjectId(i)] = 1;
  }
  EXPECT_EQ(map.Take().size(), 100u);
  EXPECT_TRUE(map.entries().empty());
  EXPECT_EQ(map.Find(ObjectId(5)), nullptr);
  EXPECT_EQ(++map[ObjectId(5)], 1);
  EXPECT_EQ(map.entries().size(), 1u);
}

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

TEST(IndicesOfValid, LeavesOutInvalidIds) {
  const std::vector<LandmarkId> ids = {LandmarkId(), LandmarkId(7), LandmarkId(), LandmarkId(0)};
  EXPECT_EQ(IndicesOfValid(ids), (std::vector<uint32_t>{1, 3}));
  EXPECT_TRUE(IndicesOfValid(std::vector<ObjectId>{ObjectId()}).empty());
}

}  // namespace

}  // namespace hullslam

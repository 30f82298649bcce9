// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/id_map.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

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

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/request_memory.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(RequestMemory, CountsRequestsUntilAnObjectIsMappedForTheFirstTime) {
  Map map;
  RequestMemory memory;
  EXPECT_EQ(memory.CountFruitless(map), 0);
  const ObjectId first = map.AddObject();
  memory.AddRequest();
  memory.AddRequest();
  EXPECT_EQ(memory.CountFruitless(map), 2);  // a candidate is no success
  map.MutableObject(first).state = ObjectState::kMapped;
  EXPECT_EQ(memory.CountFruitless(map), 0);
  memory.AddRequest();
  EXPECT_EQ(memory.CountFruitless(map), 1);
  map.MutableObject(first).state = ObjectState::kCandidate;
  EXPECT_EQ(memory.CountFruitless(map), 1);
  map.MutableObject(first).state = ObjectState::kMapped;  // again
  EXPECT_EQ(memory.CountFruitless(map), 1);
  map.MutableObject(map.AddObject()).state = ObjectState::kMapped;
  EXPECT_EQ(memory.CountFruitless(map), 0);
}

TEST(RequestMemory, LooksAtEverySnapshot) {
  Map map;
  RequestMemory memory;
  memory.AddRequest();
  const ObjectId object = map.AddObject();
  EXPECT_EQ(memory.CountFruitless(map.Snapshot()), 1);
  map.MutableObject(object).state = ObjectState::kMapped;
  const Map snapshot = map.Snapshot();
  EXPECT_EQ(memory.CountFruitless(snapshot), 0);
  memory.AddRequest();
  EXPECT_EQ(memory.CountFruitless(snapshot), 1);
}

TEST(ObjectRequestRule, AsksMoreSeldomAfterSeveralFruitlessRequests) {
  const ObjectRequestRule rule;
  EXPECT_DOUBLE_EQ(rule.TimeAfter(0), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(rule.TimeAfter(3), 1.0 / 3.0);
  for (int fruitless = 4; fruitless < 8; ++fruitless) {
    EXPECT_NEAR(rule.TimeAfter(fruitless), 2.0 * rule.TimeAfter(fruitless - 1), 1e-12);
  }
  EXPECT_NEAR(rule.TimeAfter(100), 16.0 / 3.0, 1e-12);
}

}  // namespace
}  // namespace hullslam

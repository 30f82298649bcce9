// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/replacements.h"

#include <gtest/gtest.h>

#include <set>

#include "hullslam/util/id.h"

namespace hullslam {
namespace {

TEST(Replacements, FindsTheIdThatReplacedAnother) {
  Replacements<ObjectId> replacements;
  EXPECT_EQ(replacements.Find(ObjectId(1)), nullptr);
  replacements.Add(ObjectId(5), ObjectId(2), 0);
  replacements.Add(ObjectId(1), ObjectId(7), 0);
  ASSERT_NE(replacements.Find(ObjectId(1)), nullptr);
  EXPECT_EQ(*replacements.Find(ObjectId(1)), ObjectId(7));
  EXPECT_EQ(*replacements.Find(ObjectId(5)), ObjectId(2));
  EXPECT_EQ(replacements.Find(ObjectId(2)), nullptr);
  EXPECT_EQ(replacements.Find(ObjectId()), nullptr);
  EXPECT_EQ(replacements.size(), 2u);
}

struct IdTable {
  std::set<ObjectId> ids;
  bool Contains(ObjectId id) const { return ids.contains(id); }
};

TEST(Replacements, ResolveLeadsToTheIdThatTheTableHas) {
  Replacements<ObjectId> replacements;
  replacements.Add(ObjectId(1), ObjectId(7), 0);
  replacements.Add(ObjectId(7), ObjectId(8), 1);
  EXPECT_EQ(replacements.Resolve(IdTable{{ObjectId(1), ObjectId(8)}}, ObjectId(1)), ObjectId(1));
  EXPECT_EQ(replacements.Resolve(IdTable{{ObjectId(8)}}, ObjectId(1)), ObjectId(8));
  EXPECT_FALSE(replacements.Resolve(IdTable{{ObjectId(9)}}, ObjectId(1)).IsValid());
  EXPECT_FALSE(replacements.Resolve(IdTable{{ObjectId(9)}}, ObjectId()).IsValid());
}

TEST(Replacements, TellsGenerationsOfASlotApart) {
  Replacements<LandmarkId> replacements;
  replacements.Add(LandmarkId(3, 0), LandmarkId(1), 0);
  replacements.Add(LandmarkId(3, 1), LandmarkId(2), 0);
  EXPECT_EQ(*replacements.Find(LandmarkId(3, 0)), LandmarkId(1));
  EXPECT_EQ(*replacements.Find(LandmarkId(3, 1)), LandmarkId(2));
  EXPECT_EQ(replacements.Find(LandmarkId(3, 2)), nullptr);
}

TEST(Replacements, KeepsThoseOfSmallIdsAndFollowsThem) {
  Replacements<ObjectId> replacements;
  replacements.Add(ObjectId(1), ObjectId(7), 0);
  replacements.Add(ObjectId(7), ObjectId(8), 1);
  replacements.Add(ObjectId(8), ObjectId(9), 2);
  replacements.Forget(10, ObjectId(2));
  EXPECT_EQ(replacements.size(), 1u);
  ASSERT_NE(replacements.Find(ObjectId(1)), nullptr);
  EXPECT_EQ(*replacements.Find(ObjectId(1)), ObjectId(9));
}

TEST(Replacements, ForgetsOlderOnesOnly) {
  Replacements<ObjectId> replacements;
  for (uint32_t i = 0; i < 10; ++i) {
    replacements.Add(ObjectId(i), ObjectId(100), i);
  }
  replacements.Forget(0);
  EXPECT_EQ(replacements.size(), 10u);
  replacements.Forget(4);
  EXPECT_EQ(replacements.size(), 6u);
  EXPECT_EQ(replacements.Find(ObjectId(3)), nullptr);
  EXPECT_NE(replacements.Find(ObjectId(4)), nullptr);
}

}  // namespace
}  // namespace hullslam

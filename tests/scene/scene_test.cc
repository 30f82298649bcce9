// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene.h"

#include <gtest/gtest.h>

#include "scene/made_scene.h"

namespace hullslam {
namespace {

TEST(Scene, NamesOfRelationsAreReadBack) {
  for (size_t i = 0; i < kRelationKinds; ++i) {
    const auto kind = static_cast<RelationKind>(i);
    EXPECT_EQ(ParseRelationKind(ToString(kind)), kind);
  }
  EXPECT_EQ(ToString(RelationKind::kInFrontOf), "in front of");
  EXPECT_FALSE(ParseRelationKind("above"));
}

TEST(Scene, FindsObjectsByTheirIds) {
  const Scene scene = MakeQueryScene();
  ASSERT_NE(scene.Find(ObjectId(5)), nullptr);
  EXPECT_EQ(scene.Find(ObjectId(5))->label, "laptop");
  EXPECT_EQ(scene.Find(ObjectId(4)), nullptr);
  EXPECT_EQ(scene.Find(ObjectId(9)), nullptr);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/object_primitive.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(ObjectPrimitive, NamesAreThoseOfTheSettings) {
  EXPECT_EQ(NameOf(ObjectPrimitive::kSupport), "support");
  EXPECT_EQ(NameOf(ObjectPrimitive::kHull), "hull");
  EXPECT_EQ(NameOf(ObjectPrimitive::kContour), "contour");
  EXPECT_EQ(NameOf(ObjectPrimitive::kBox), "bbox");
  EXPECT_EQ(NameOf(ObjectPrimitive::kConic), "conic");
}

TEST(ObjectPrimitive, EveryNameLeadsBack) {
  ASSERT_EQ(ObjectPrimitiveNames().size(), 5u);
  for (const std::string& name : ObjectPrimitiveNames()) {
    ASSERT_TRUE(ObjectPrimitiveByName(name).has_value()) << name;
    EXPECT_EQ(NameOf(*ObjectPrimitiveByName(name)), name);
  }
}

TEST(ObjectPrimitive, OtherNamesAreNone) {
  for (const char* name : {"", "Support", "support ", "box", "hulls", "tangent"}) {
    EXPECT_FALSE(ObjectPrimitiveByName(name).has_value()) << name;
  }
}

}  // namespace
}  // namespace hullslam

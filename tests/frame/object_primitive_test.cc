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
  EXPECT_EQ(NameOf(ObjectPrimitive::kBoxEllipse), "box_ellipse");
}

TEST(ObjectPrimitive, NamesAreInTheOrderOfTheEnumerators) {
  const std::vector<std::string> names = ObjectPrimitiveNames();
  ASSERT_EQ(names.size(), 6u);
  for (size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(NameOf(static_cast<ObjectPrimitive>(i)), names[i]);
  }
}

}  // namespace
}  // namespace hullslam

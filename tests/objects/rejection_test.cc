// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/rejection.h"

#include <gtest/gtest.h>

#include <set>

namespace hullslam {
namespace {

TEST(ObjectRejection, EveryReasonHasAName) {
  std::set<std::string> names;
  for (int i = 0; i < kObjectRejectionCount; ++i) {
    names.insert(ToString(static_cast<ObjectRejection>(i)));
  }
  EXPECT_EQ(names.size(), static_cast<size_t>(kObjectRejectionCount));
  EXPECT_EQ(ToString(ObjectRejection::kFewKeyframes), "few_views");
  EXPECT_EQ(ToString(ObjectRejection::kFused), "fused");
}

}  // namespace
}  // namespace hullslam

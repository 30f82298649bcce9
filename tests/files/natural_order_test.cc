// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/natural_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace hullslam {
namespace {

TEST(NaturalOrder, ComparesNumbersByValue) {
  const std::vector<std::string> ordered = {
      "",       "1.png",    "2.png",     "10.png",     "99999999999999999999999.png",
      "a",      "a1b2.png", "a1b10.png", "a01b11.png", "a2b1.png",
      "frame2", "frame10",  "frame10a",  "frames"};
  for (size_t i = 0; i < ordered.size(); ++i) {
    for (size_t j = 0; j < ordered.size(); ++j) {
      EXPECT_EQ(IsNaturallyBefore(ordered[i], ordered[j]), i < j)
          << ordered[i] << " and " << ordered[j];
    }
  }
}

TEST(NaturalOrder, LeadingZerosDecideLast) {
  EXPECT_TRUE(IsNaturallyBefore("f01", "f1"));
  EXPECT_FALSE(IsNaturallyBefore("f1", "f01"));
  EXPECT_TRUE(IsNaturallyBefore("f1a", "f01b"));
  EXPECT_TRUE(IsNaturallyBefore("0", "00") != IsNaturallyBefore("00", "0"));
}

}  // namespace
}  // namespace hullslam

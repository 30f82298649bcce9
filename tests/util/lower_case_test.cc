// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/lower_case.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(LowerCase, ChangesTheLettersFromAToZOnly) {
  EXPECT_EQ(LowerCase("Freiburg1_XYZ [@`{].PNG"), "freiburg1_xyz [@`{].png");
  EXPECT_EQ(LowerCase("\xC3\x84pfel, \xC4"), "\xC3\x84pfel, \xC4");  // in UTF-8 and in Latin-1
  EXPECT_EQ(LowerCase(""), "");
}

TEST(LowerCase, TwiceIsOnce) {
  std::string all;
  for (int c = 0; c < 256; ++c) {
    all += static_cast<char>(c);
  }
  const std::string once = LowerCase(all);
  EXPECT_EQ(LowerCase(once), once);
  EXPECT_EQ(once.size(), all.size());
}

}  // namespace
}  // namespace hullslam

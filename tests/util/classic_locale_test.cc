// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/classic_locale.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "support/comma_locale.h"

namespace hullslam {
namespace {

TEST(ClassicLocaleTest, NumbersHavePointsWhileItExists) {
  const CommaLocale comma;
  {
    const ClassicLocale classic;
    EXPECT_EQ(std::strtod("1.5", nullptr), 1.5);
    {
      const ClassicLocale nested;
      EXPECT_EQ(std::strtod("1.5", nullptr), 1.5);
    }
    EXPECT_EQ(std::strtod("1.5", nullptr), 1.5);
  }
  EXPECT_EQ(std::strtod("1.5", nullptr), 1.0);
}

}  // namespace
}  // namespace hullslam

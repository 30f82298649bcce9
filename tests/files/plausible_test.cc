// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/plausible.h"

#include <gtest/gtest.h>

#include <limits>

namespace hullslam {
namespace {

TEST(Plausible, QuaternionsThatCanBeNormalisedAreRotations) {
  for (const double length : {1.0, 0.01, 100.0}) {
    EXPECT_TRUE(IsPlausibleRotation({0.0, 0.0, length, 0.0})) << length;
  }
}

TEST(Plausible, ZeroHugeAndInvalidQuaternionsAreNoRotations) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double length : {0.0, 1e-200, 1e-6, 1e6, 1e200, kNan}) {
    EXPECT_FALSE(IsPlausibleRotation({0.0, 0.0, length, 0.0})) << length;
  }
}

}  // namespace
}  // namespace hullslam

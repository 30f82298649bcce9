// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hullslam {
namespace {

// With q = x / 2, P(chi2 > x) is erfc(sqrt(q)) for one degree of freedom, exp(-q) for two and
// erfc(sqrt(q)) + 2 sqrt(q / pi) exp(-q) for three.
TEST(Chi2Bound, LeavesFivePercentAbove) {
  const auto above_one = [](double x) { return std::erfc(std::sqrt(0.5 * x)); };
  EXPECT_NEAR(above_one(Chi2Bound(1)), 0.05, 1e-4);
  EXPECT_NEAR(std::exp(-0.5 * Chi2Bound(2)), 0.05, 1e-4);
  const double x = Chi2Bound(3);
  EXPECT_NEAR(above_one(x) + std::sqrt(2.0 * x / std::numbers::pi) * std::exp(-0.5 * x), 0.05,
              1e-4);
}

TEST(Chi2Bound, IsKnownForOneToThreeDegreesOfFreedom) {
  EXPECT_THROW(Chi2Bound(0), std::out_of_range);
  EXPECT_THROW(Chi2Bound(4), std::out_of_range);
}

}  // namespace
}  // namespace hullslam

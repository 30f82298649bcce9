// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/costs/quadric_prior_sigmas.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(QuadricPriorSigmas, ArePositiveByDefault) {
  constexpr QuadricPriorSigmas kSigmas;
  EXPECT_GT(kSigmas.log_axes, 0.0);
  EXPECT_GT(kSigmas.center, 0.0);
  EXPECT_GT(kSigmas.rotation, 0.0);
}

}  // namespace
}  // namespace hullslam

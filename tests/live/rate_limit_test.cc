// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/rate_limit.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

using namespace std::chrono_literals;

TEST(RateLimit, LetsABurstPassAndThenSpreadsEventsOut) {
  RateLimit limit(10.0, 3.0);
  const auto now = RateLimit::Clock::now() + 1h;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(limit.Take(now), 0ns) << i;
  }
  EXPECT_NEAR(std::chrono::duration<double>(limit.Take(now)).count(), 0.1, 1e-6);
  EXPECT_NEAR(std::chrono::duration<double>(limit.Take(now)).count(), 0.2, 1e-6);
}

TEST(RateLimit, RestAllowsNoMoreThanTheBurst) {
  RateLimit limit(10.0, 3.0);
  const auto now = RateLimit::Clock::now() + 1h;
  limit.Take(now);
  const auto later = now + 1h;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(limit.Take(later), 0ns) << i;
  }
  EXPECT_GT(limit.Take(later), 0ns);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/island_rules.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(IslandRules, WithDepthOneFrameMakesTheOnlyIsland) {
  const IslandRules rules = IslandRules::ForSensor(SensorKind::kRgbd);
  EXPECT_FALSE(rules.needs_motion);
  EXPECT_FALSE(rules.begins_when_lost);
}

TEST(IslandRules, AMonocularCameraNeedsMotionAndGoesOnWhenLost) {
  const IslandRules rules = IslandRules::ForSensor(SensorKind::kMonocular);
  EXPECT_TRUE(rules.needs_motion);
  EXPECT_TRUE(rules.begins_when_lost);
}

}  // namespace
}  // namespace hullslam

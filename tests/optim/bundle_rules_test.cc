// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_rules.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(BundleRules, WithDepthTheErrorsAreThoseOfTheSensor) {
  const BundleRules rules = BundleRules::ForSensor(SensorKind::kRgbd);
  EXPECT_FALSE(rules.precision_is_measured);
  EXPECT_FALSE(rules.keypoints_share_weights);
  EXPECT_FALSE(rules.keeps_scale);
  EXPECT_EQ(rules.robust_loss, PointLoss::kHuber);
  EXPECT_EQ(rules.final_loss, PointLoss::kNone);
}

TEST(BundleRules, WithoutDepthTheScaleIsProtected) {
  const BundleRules rules = BundleRules::ForSensor(SensorKind::kMonocular);
  EXPECT_TRUE(rules.is_solved_precisely);
  EXPECT_TRUE(rules.precision_is_measured);
  EXPECT_TRUE(rules.keypoints_share_weights);
  EXPECT_TRUE(rules.keeps_scale);
  // Points that slide along edges are in both rounds.
  EXPECT_EQ(rules.robust_loss, PointLoss::kCauchy);
  EXPECT_EQ(rules.final_loss, PointLoss::kCauchy);
}

}  // namespace
}  // namespace hullslam

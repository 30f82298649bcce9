// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_options.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(BundleOptions, ForMonocularTheyAreNoLessPrecise) {
  const BundleOptions local = BundleOptions().ForMonocular();
  EXPECT_GT(local.robust_iterations, BundleOptions().robust_iterations);
  EXPECT_GT(local.final_iterations, BundleOptions().final_iterations);
  EXPECT_LT(local.function_tolerance, BundleOptions().function_tolerance);
  EXPECT_GT(local.follow.steps, BundleOptions().follow.steps);
  EXPECT_LT(local.follow.worthwhile, BundleOptions().follow.worthwhile);
  const BundleOptions precise = BundleOptions{.robust_iterations = 50,
                                              .final_iterations = 60,
                                              .function_tolerance = 1e-14,
                                              .follow = {.steps = 20, .worthwhile = 1e-9}}
                                    .ForMonocular();
  EXPECT_EQ(precise.robust_iterations, 50);
  EXPECT_EQ(precise.final_iterations, 60);
  EXPECT_EQ(precise.function_tolerance, 1e-14);
  EXPECT_EQ(precise.follow.steps, 20);
  EXPECT_EQ(precise.follow.worthwhile, 1e-9);
}

TEST(BundleRules, ForRgbdTheErrorsOfTheSensorAreUsed) {
  const BundleRules rules = BundleRules::ForSensor(Sensor());
  EXPECT_FALSE(rules.precision_is_measured);
  EXPECT_FALSE(rules.keypoints_share_weights);
  EXPECT_FALSE(rules.keeps_scale);
  EXPECT_EQ(rules.robust_loss, PointLoss::kHuber);
  EXPECT_EQ(rules.final_loss, PointLoss::kNone);
}

TEST(BundleRules, ForMonocularTheScaleIsProtected) {
  Sensor sensor;
  sensor.kind = SensorKind::kMonocular;
  const BundleRules rules = BundleRules::ForSensor(sensor);
  EXPECT_TRUE(rules.is_solved_precisely);
  EXPECT_TRUE(rules.precision_is_measured);
  EXPECT_TRUE(rules.keypoints_share_weights);
  EXPECT_TRUE(rules.keeps_scale);
  // Points that slide along edges take part in both rounds.
  EXPECT_EQ(rules.robust_loss, PointLoss::kCauchy);
  EXPECT_EQ(rules.final_loss, PointLoss::kCauchy);
}

TEST(BundleRules, OfOrbSlam2AreThoseOfRgbdButForTheScale) {
  Sensor sensor;
  sensor.kind = SensorKind::kMonocular;
  sensor.depth_error.adjustment_rule = AdjustmentRule::kOrbSlam2;
  const BundleRules rules = BundleRules::ForSensor(sensor);
  EXPECT_FALSE(rules.is_solved_precisely);
  EXPECT_FALSE(rules.precision_is_measured);
  EXPECT_FALSE(rules.keypoints_share_weights);
  EXPECT_TRUE(rules.keeps_scale) << "nothing else fixes it";
  EXPECT_EQ(rules.robust_loss, PointLoss::kHuber);
  EXPECT_EQ(rules.final_loss, PointLoss::kNone);
}

// Parts of a whole map move with their objects, whose shapes stay as they are held.
TEST(BundleOptions, ForAWholeMapObjectsMayMoveFarther) {
  const BundleOptions local;
  const BundleOptions whole = local.ForWholeMap();
  const ObjectConstraintOptions& before = local.objects.constraint;
  const ObjectConstraintOptions& after = whole.objects.constraint;
  for (const auto prior :
       {&ObjectConstraintOptions::prior, &ObjectConstraintOptions::prior_without_depth}) {
    EXPECT_EQ((after.*prior).center, 20.0 * (before.*prior).center);
    EXPECT_EQ((after.*prior).rotation, 20.0 * (before.*prior).rotation);
    EXPECT_EQ((after.*prior).log_axes, (before.*prior).log_axes);
  }
  EXPECT_GT(whole.final_iterations, local.final_iterations);
  EXPECT_LE(whole.function_tolerance, local.function_tolerance);
}

}  // namespace
}  // namespace hullslam

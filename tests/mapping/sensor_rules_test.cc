// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/sensor_rules.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

constexpr int kWeightWithDepth = 2;
constexpr int kWeightWithoutDepth = 1;

Sensor MakeSensor(SensorKind kind) {
  Sensor sensor;
  sensor.kind = kind;
  sensor.camera.fx = 500.0;
  sensor.camera.bf = 40.0;
  return sensor;
}

TEST(CullingRules, TwoObservationsWithDepthAreEnoughForALandmark) {
  const CullingRules rules = CullingRules::ForSensor(SensorKind::kRgbd);
  EXPECT_LE(kWeightWithDepth + kWeightWithoutDepth, rules.max_weak_weight);
  EXPECT_GT(2 * kWeightWithDepth, rules.max_weak_weight);
}

TEST(CullingRules, AMonocularLandmarkNeedsAThirdObservation) {
  const CullingRules rules = CullingRules::ForSensor(SensorKind::kMonocular);
  EXPECT_LE(2 * kWeightWithoutDepth, rules.max_weak_weight);
  EXPECT_GT(3 * kWeightWithoutDepth, rules.max_weak_weight);
}

TEST(CullingRules, MonocularObserversNeedParallax) {
  const CullingRules depth = CullingRules::ForSensor(SensorKind::kRgbd);
  const CullingRules monocular = CullingRules::ForSensor(SensorKind::kMonocular);
  EXPECT_EQ(monocular.other_observers, depth.other_observers);
  EXPECT_TRUE(monocular.observers_need_parallax);
  EXPECT_FALSE(depth.observers_need_parallax);
}

TEST(CullingRules, NoSensorNeedsMoreObserversThanTheLargestNumber) {
  for (const SensorKind kind : {SensorKind::kRgbd, SensorKind::kMonocular}) {
    const CullingRules rules = CullingRules::ForSensor(kind);
    EXPECT_GT(rules.other_observers, 0u);
    EXPECT_LE(rules.other_observers, CullingRules::kMaxOtherObservers);
  }
}

TEST(CullingRules, OfOrbSlam2NeedThreeOthersWithAndWithoutDepth) {
  for (const SensorKind kind : {SensorKind::kRgbd, SensorKind::kMonocular}) {
    const CullingRules rules = CullingRules::ForSensor(kind, MappingRule::kOrbSlam2);
    EXPECT_EQ(rules.other_observers, 3u);
    EXPECT_FALSE(rules.observers_need_parallax);
    EXPECT_FALSE(rules.keeps_object_views);
    EXPECT_EQ(rules.max_weak_weight, CullingRules::ForSensor(kind).max_weak_weight);
    EXPECT_EQ(rules.only_close_landmarks, kind == SensorKind::kRgbd);
  }
}

TEST(LandmarkRules, OfOrbSlam2LetTheOwnParallaxDecide) {
  const LandmarkRules rules =
      LandmarkRules::ForSensor(MakeSensor(SensorKind::kMonocular), MappingRule::kOrbSlam2);
  EXPECT_FALSE(rules.nearby_landmarks_decide);
  EXPECT_DOUBLE_EQ(rules.min_baseline_share, 0.01);
  EXPECT_EQ(rules.neighbours, 20u);
}

TEST(LandmarkRules, ForRgbdTheShortestBaselineIsThatOfTheVirtualStereoPair) {
  const LandmarkRules rules = LandmarkRules::ForSensor(MakeSensor(SensorKind::kRgbd));
  ASSERT_TRUE(rules.min_baseline);
  EXPECT_DOUBLE_EQ(*rules.min_baseline, 0.08);
  EXPECT_FALSE(rules.nearby_landmarks_decide);
}

TEST(LandmarkRules, ForMonocularTheShortestBaselineIsAShareOfTheDepth) {
  const LandmarkRules rules = LandmarkRules::ForSensor(MakeSensor(SensorKind::kMonocular));
  EXPECT_FALSE(rules.min_baseline);
  EXPECT_GT(rules.min_baseline_share, 0.0);
  EXPECT_TRUE(rules.nearby_landmarks_decide);
}

TEST(LandmarkRules, AMonocularKeyframeIsPairedWithMoreNeighbours) {
  EXPECT_GT(LandmarkRules::ForSensor(MakeSensor(SensorKind::kMonocular)).neighbours,
            LandmarkRules::ForSensor(MakeSensor(SensorKind::kRgbd)).neighbours);
}

}  // namespace
}  // namespace hullslam

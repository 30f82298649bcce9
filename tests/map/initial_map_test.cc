// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/initial_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace hullslam {
namespace {

// Two views side by side, whose rays to every point in the middle between them at the depth 2 have
// this angle (degrees).
InitialMap MapOfParallax(double degrees, size_t points = 60) {
  const double baseline = 4.0 * std::tan(0.5 * degrees * std::numbers::pi / 180.0);
  InitialMap map;
  map.views = {
      {nullptr, Rigid3()},
      {nullptr, Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-baseline, 0.0, 0.0))}};
  for (size_t i = 0; i < points; ++i) {
    map.points.push_back({.position = {0.5 * baseline, 0.0, 2.0}, .observations = {}});
  }
  return map;
}

void AddPoints(const Eigen::Vector3d& position, size_t count, InitialMap& map) {
  for (size_t i = 0; i < count; ++i) {
    map.points.push_back({.position = position, .observations = {}});
  }
}

TEST(InitialMapEnd, MakesTheMedianDepthOne) {
  InitialMap map = MapOfParallax(20.0);
  AddPoints({0.5, 0.25, 4.0}, 20, map);
  const double baseline = -map.views[1].cam_from_world.translation.x();
  EXPECT_EQ(FinishInitialMap(map), std::nullopt);
  EXPECT_EQ(map.points.size(), 80U);
  EXPECT_DOUBLE_EQ(map.points.front().position.z(), 1.0);
  EXPECT_LT((map.points.back().position - Eigen::Vector3d(0.25, 0.125, 2.0)).norm(), 1e-12);
  EXPECT_EQ(map.views[0].cam_from_world.translation, Eigen::Vector3d::Zero());
  EXPECT_DOUBLE_EQ(map.views[1].cam_from_world.translation.x(), -0.5 * baseline);
}

TEST(InitialMapEnd, RemovesPointsThatAreNotInFrontOfTheFirstView) {
  InitialMap map = MapOfParallax(20.0);
  AddPoints({0.0, 0.0, -1.0}, 70, map);
  AddPoints({0.1, 0.0, 0.0}, 1, map);
  AddPoints({0.0, 0.0, std::numeric_limits<double>::quiet_NaN()}, 1, map);
  EXPECT_EQ(FinishInitialMap(map), std::nullopt);
  EXPECT_EQ(map.points.size(), 60U);
  EXPECT_DOUBLE_EQ(map.points.front().position.z(), 1.0);
}

TEST(InitialMapEnd, NeedsFiftyPointsInFront) {
  InitialMap enough = MapOfParallax(20.0, 50);
  EXPECT_EQ(FinishInitialMap(enough), std::nullopt);
  InitialMap few = MapOfParallax(20.0, 49);
  AddPoints({0.0, 0.0, -1.0}, 20, few);
  EXPECT_EQ(FinishInitialMap(few), InitialisationFailure::kTooFewPoints);
}

TEST(InitialMapEnd, NeedsADegreeOfParallaxInTheMedian) {
  InitialMap enough = MapOfParallax(1.05);
  AddPoints({0.0, 0.0, 1e6}, 50, enough);  // without parallax, but fewer than half
  EXPECT_EQ(FinishInitialMap(enough), std::nullopt);
  InitialMap little = MapOfParallax(0.95);
  AddPoints({0.0, 0.0, 0.1}, 50, little);  // with much more, but fewer than half
  EXPECT_EQ(FinishInitialMap(little), InitialisationFailure::kTooLittleParallax);
}

TEST(InitialMapEnd, NeedsTheParallaxOfTheShareThatIsAskedFor) {
  InitialMap map = MapOfParallax(1.05);
  AddPoints({0.0, 0.0, 1e6}, 150, map);  // 60 of 210 points have parallax
  InitialMap copy = map;
  EXPECT_EQ(FinishInitialMap(copy), InitialisationFailure::kTooLittleParallax);
  EXPECT_EQ(FinishInitialMap(map, 0.25), std::nullopt);
  AddPoints({0.0, 0.0, 1e6}, 50, map);
  EXPECT_EQ(FinishInitialMap(map, 0.25), InitialisationFailure::kTooLittleParallax);
}

}  // namespace
}  // namespace hullslam

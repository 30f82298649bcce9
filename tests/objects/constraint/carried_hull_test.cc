// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/constraint/carried_hull.h"

#include <gtest/gtest.h>

#include "geometry/polygon.h"
#include "objects/made_objects.h"

namespace hullslam {
namespace {

class CarriedHull : public ::testing::Test {
 protected:
  Rigid3 Sideways(double x) const { return {Eigen::Quaterniond::Identity(), {-x, 0.0, 0.0}}; }

  Sensor sensor_ = MakeObjectSensor();
  MadeObject cup_ = MakeObject("cup", {0.0, 0.0, 1.0}, {0.03, 0.03, 0.03});
  Detection last_ = Detect(cup_, sensor_, Sideways(0.0));
  ResolvedObservation observation_{KeyframeId(0), Sideways(0.0), &last_};
};

TEST_F(CarriedHull, WithDepthPointsItLiesWhereTheObjectIsSeen) {
  const auto carried = CarryHull(sensor_, {&observation_, 1}, Sideways(0.05));
  ASSERT_EQ(carried.size(), 1u);
  const Detection now = Detect(cup_, sensor_, Sideways(0.05));
  EXPECT_GT(IntersectionOverUnion(carried[0], now.hull), 0.9);
  EXPECT_LT(IntersectionOverUnion(last_.hull, now.hull), 0.3) << "it has moved";
}

TEST_F(CarriedHull, OfUnknownDepthItLiesAtSeveralPlaces) {
  last_.points.clear();
  const auto carried = CarryHull(sensor_, {&observation_, 1}, Sideways(0.05));
  ASSERT_EQ(carried.size(), 5u);
  EXPECT_GT(IntersectionOverUnion(carried.front(), last_.hull), 0.99) << "at infinity";
  const double moved = BoundingBox(carried.back()).center().x() - last_.box.center().x();
  EXPECT_NEAR(std::abs(moved), last_.box.sizes().minCoeff(), 2.0) << "by its own size";
  EXPECT_EQ(CarryHull(sensor_, {&observation_, 1}, Sideways(0.0)).size(), 1u)
      << "it cannot have moved";
}

TEST_F(CarriedHull, BehindTheCameraItIsEmpty) {
  const Rigid3 turned{Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0), Eigen::Vector3d::Zero()};
  const auto carried = CarryHull(sensor_, {&observation_, 1}, turned);
  ASSERT_EQ(carried.size(), 1u);
  EXPECT_TRUE(carried[0].empty());
}

}  // namespace
}  // namespace hullslam

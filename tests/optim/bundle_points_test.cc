// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_points.h"

#include <gtest/gtest.h>

#include <utility>

namespace hullslam::internal {
namespace {

TEST(BundlePoints, KeepsTheViewsOfEachPoint) {
  BundlePoints points;
  points.AddPoint({1.0, 2.0, 3.0});
  points.AddView({}, 4);
  points.AddView({}, 5);
  points.AddPoint({0.0, 0.0, 1.0});
  points.AddPoint({4.0, 5.0, 6.0});
  points.AddView({}, 6, 0.5);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points.positions()[2], Eigen::Vector3d(4.0, 5.0, 6.0));
  ASSERT_EQ(std::as_const(points).ObservationsOf(0).size(), 2u);
  EXPECT_EQ(points.ObservationsOf(0)[1].pose, 5u);
  EXPECT_TRUE(points.ObservationsOf(1).empty());
  ASSERT_EQ(points.ObservationsOf(2).size(), 1u);
  EXPECT_EQ(points.ObservationsOf(2)[0].pose, 6u);
  EXPECT_EQ(points.ObservationsOf(2)[0].weight, 0.5);
  EXPECT_EQ(points.ObservationsOf(0)[0].weight, 1.0) << "the default weight";
}

TEST(BundlePoints, ViewsAreInliersUntilTheyAreLeftOut) {
  BundlePoints points;
  points.AddPoint({1.0, 2.0, 3.0});
  points.AddView({}, 0);
  points.AddView({}, 1);
  EXPECT_EQ(points.CountInliers(), 2);
  points.ObservationsOf(0)[0].is_inlier = false;
  EXPECT_EQ(points.CountInliers(), 1);
}

}  // namespace
}  // namespace hullslam::internal

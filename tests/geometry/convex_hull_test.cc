// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/convex_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/polyline.h"
#include "hullslam/util/check.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

using Points = std::vector<Eigen::Vector2d>;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Random points. On a grid many of them coincide and many lie on common lines.
Points RandomPoints(RandomGeometry& random, int count, bool on_grid) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d p(random.Number(0.0, 12.0), random.Number(0.0, 9.0));
    points.emplace_back(on_grid ? p.array().round().matrix() : p);
  }
  return points;
}

bool IsAmong(const Points& points, const Eigen::Vector2d& point) {
  return std::find(points.begin(), points.end(), point) != points.end();
}

TEST(ConvexHull, OfASquareIgnoresPointsInsideAndOnItsSides) {
  const Points points{{2.0, 2.0}, {0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}, {1.0, 1.0},
                      {0.0, 2.0}, {0.0, 1.0}, {2.0, 0.0}, {0.0, 0.0}};
  EXPECT_EQ(ConvexHull(points), (Points{{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}, {0.0, 2.0}}));
}

TEST(ConvexHull, OfRandomPointsIsStrictlyConvexAndContainsThemAll) {
  RandomGeometry random(1);
  for (int round = 0; round < 200; ++round) {
    const int count = 3 + static_cast<int>(random.Index(60));
    const Points points = RandomPoints(random, count, round % 2 == 0);
    const Points hull = ConvexHull(points);
    if (hull.size() < 3) {
      continue;  // a few points of the grid may all be on one line
    }
    EXPECT_GT(SignedArea(hull), 0.0);
    for (size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d& a = hull[i];
      const Eigen::Vector2d& b = hull[(i + 1) % hull.size()];
      EXPECT_GT(Cross(b - a, hull[(i + 2) % hull.size()] - b), 0.0);
      EXPECT_TRUE(IsAmong(points, a));
      for (const Eigen::Vector2d& p : points) {
        EXPECT_GE(Cross(b - a, p - a), -1e-12);
      }
    }
  }
}

TEST(ConvexHull, OfAHullIsTheHullInAnyOrderOfPoints) {
  RandomGeometry random(2);
  for (int round = 0; round < 50; ++round) {
    Points points = RandomPoints(random, 40, round % 2 == 0);
    const Points hull = ConvexHull(points);
    EXPECT_EQ(ConvexHull(hull), hull);
    std::reverse(points.begin(), points.end());
    points.insert(points.end(), hull.begin(), hull.end());
    EXPECT_EQ(ConvexHull(points), hull);
  }
}

TEST(ConvexHull, StartsAtTheSmallestX) {
  const Points hull = ConvexHull(Points{{5.0, 5.0}, {1.0, 3.0}, {1.0, 2.0}, {4.0, 0.0}});
  ASSERT_EQ(hull.size(), 4U);
  EXPECT_EQ(hull[0], Eigen::Vector2d(1.0, 2.0));
}

TEST(ConvexHull, HasFewerThanThreeCornersForPointsOnALine) {
  EXPECT_TRUE(ConvexHull({}).empty());
  EXPECT_EQ(ConvexHull(Points(4, Eigen::Vector2d(3.0, 4.0))), (Points{{3.0, 4.0}}));
  const Points line{{2.0, 4.0}, {1.0, 2.0}, {3.0, 6.0}, {0.0, 0.0}, {2.0, 4.0}};
  EXPECT_EQ(ConvexHull(line), (Points{{0.0, 0.0}, {3.0, 6.0}}));
}

TEST(ConvexHull, RefusesPointsThatAreNotFinite) {
  EXPECT_THROW(ConvexHull(Points{{0.0, 0.0}, {1.0, std::numeric_limits<double>::quiet_NaN()}}),
               CheckError);
  EXPECT_THROW(ConvexHull(Points{{0.0, std::numeric_limits<double>::infinity()}}), CheckError);
}

}  // namespace
}  // namespace hullslam

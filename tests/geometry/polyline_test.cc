// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/polyline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/polygon.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

// A closed star-shaped polygon with a ragged border.
Polygon RaggedPolygon(RandomGeometry& random, int corners) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    const double radius = random.Number(45.0, 55.0) + 20.0 * std::cos(3.0 * angle);
    polygon.emplace_back(300.0 + radius * std::cos(angle), 200.0 + radius * std::sin(angle));
  }
  return polygon;
}

double DistanceTo(const Polygon& polygon, const Eigen::Vector2d& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d along = polygon[(i + 1) % polygon.size()] - a;
    const double share =
        std::clamp((point - a).dot(along) / std::max(along.squaredNorm(), 1e-30), 0.0, 1.0);
    nearest = std::min(nearest, (point - a - share * along).norm());
  }
  return nearest;
}

TEST(SimplifyPolygon, KeepsOnlyTheCornersOfASquare) {
  Polygon square;
  for (int i = 0; i < 10; ++i) square.emplace_back(i, 0.1 * (i % 2));
  for (int i = 0; i < 10; ++i) square.emplace_back(10.0, i);
  for (int i = 0; i < 10; ++i) square.emplace_back(10.0 - i, 10.0);
  for (int i = 0; i < 10; ++i) square.emplace_back(0.0, 10.0 - i);
  EXPECT_EQ(SimplifyPolygon(square, 0.5),
            (Polygon{{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}, {0.0, 10.0}}));
}

TEST(SimplifyPolygon, KeepsEveryCornerWithinEpsilon) {
  RandomGeometry random(1);
  for (int round = 0; round < 40; ++round) {
    const Polygon outline = RaggedPolygon(random, 150);
    size_t before = outline.size();
    for (const double epsilon : {0.5, 3.0, 6.0, 12.0}) {
      const Polygon simplified = SimplifyPolygon(outline, epsilon);
      EXPECT_LE(simplified.size(), before);
      before = simplified.size();
      for (const Eigen::Vector2d& corner : outline) {
        EXPECT_LE(DistanceTo(simplified, corner), epsilon + 1e-9);
      }
    }
    EXPECT_LT(before, outline.size() / 4);
  }
}

TEST(SimplifyPolygon, GivesCornersOfThePolygonInTheirOrder) {
  RandomGeometry random(2);
  const Polygon outline = RaggedPolygon(random, 100);
  const Polygon simplified = SimplifyPolygon(outline, 4.0);
  auto next = outline.begin();
  for (const Eigen::Vector2d& corner : simplified) {
    next = std::find(next, outline.end(), corner);
    ASSERT_NE(next, outline.end());
  }
}

TEST(SimplifyPolygon, OfAConvexPolygonIsConvex) {
  RandomGeometry random(3);
  const Polygon hull = ConvexHull(RaggedPolygon(random, 200));
  const Polygon simplified = SimplifyPolygon(hull, 3.0);
  ASSERT_GE(simplified.size(), 3U);
  EXPECT_EQ(ConvexHull(simplified).size(), simplified.size());
  EXPECT_LT(SignedArea(simplified), SignedArea(hull));  // its chords lie inside the hull
}

TEST(SimplifyPolygon, WithoutEpsilonChangesNothing) {
  RandomGeometry random(4);
  const Polygon outline = RaggedPolygon(random, 50);
  EXPECT_EQ(SimplifyPolygon(outline, 0.0), outline);
}

TEST(SimplifyPolygon, HandlesDegeneratePolygons) {
  EXPECT_TRUE(SimplifyPolygon({}, 3.0).empty());
  EXPECT_EQ(SimplifyPolygon(Polygon(5, Eigen::Vector2d(1.0, 2.0)), 3.0).size(), 1U);
  const Polygon line{{0.0, 0.0}, {5.0, 1.0}, {10.0, 2.0}, {5.0, 1.0}};
  EXPECT_EQ(SimplifyPolygon(line, 1.0), (Polygon{{0.0, 0.0}, {10.0, 2.0}}));
}

TEST(SignedArea, MatchesHandComputedValuesAndChangesSignWithTheOrder) {
  Polygon triangle{{1000.0, 1000.0}, {1004.0, 1000.0}, {1000.0, 1003.0}};
  EXPECT_DOUBLE_EQ(SignedArea(triangle), 6.0);
  std::reverse(triangle.begin(), triangle.end());
  EXPECT_DOUBLE_EQ(SignedArea(triangle), -6.0);
  EXPECT_EQ(SignedArea({}), 0.0);
  EXPECT_EQ(SignedArea(Polygon{{1.0, 2.0}, {3.0, 4.0}}), 0.0);
}

TEST(IsInOrNearConvex, AcceptsPointsUpToTheMargin) {
  const Polygon square{{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}, {0.0, 10.0}};
  EXPECT_TRUE(IsInOrNearConvex(square, {5.0, 5.0}, 0.0));
  EXPECT_FALSE(IsInOrNearConvex(square, {11.0, 5.0}, 0.9));
  EXPECT_TRUE(IsInOrNearConvex(square, {11.0, 5.0}, 1.1));
  EXPECT_FALSE(IsInOrNearConvex(square, {5.0, -1.0}, 0.9));
  EXPECT_TRUE(IsInOrNearConvex(square, {5.0, -1.0}, 1.1));
}

TEST(BoundingBox, ContainsThePoints) {
  const std::vector<Eigen::Vector2d> points{{1.0, 5.0}, {-2.0, 3.0}, {0.0, 7.0}};
  const Eigen::AlignedBox2d box = BoundingBox(points);
  EXPECT_EQ(box.min(), Eigen::Vector2d(-2.0, 3.0));
  EXPECT_EQ(box.max(), Eigen::Vector2d(1.0, 7.0));
  EXPECT_TRUE(BoundingBox({}).isEmpty());
}

}  // namespace
}  // namespace hullslam

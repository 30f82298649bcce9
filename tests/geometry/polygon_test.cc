// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hullslam/geometry/conic.h"
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

using Polygon = std::vector<Eigen::Vector2d>;

Polygon Rectangle(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

Polygon RandomConvex(RandomGeometry& random) {
  Polygon points;
  const Eigen::Vector2d center(random.Number(200.0, 260.0), random.Number(200.0, 260.0));
  for (int i = 0; i < 12; ++i) {
    points.emplace_back(center + random.Vector(60.0).head<2>());
  }
  return ConvexHull(points);
}

TEST(IntersectionArea, OfRectanglesMatchesHandComputedValues) {
  const Polygon a = Rectangle(0.0, 0.0, 4.0, 3.0);
  EXPECT_DOUBLE_EQ(IntersectionArea(a, Rectangle(1.0, 1.0, 10.0, 10.0)), 6.0);
  EXPECT_DOUBLE_EQ(IntersectionArea(a, Rectangle(1.0, 1.0, 1.0, 0.5)), 0.5);
  EXPECT_DOUBLE_EQ(IntersectionArea(a, Rectangle(4.0, 0.0, 2.0, 3.0)), 0.0);  // they touch
  EXPECT_DOUBLE_EQ(IntersectionArea(a, Rectangle(7.0, 0.0, 2.0, 3.0)), 0.0);
  EXPECT_DOUBLE_EQ(IntersectionOverUnion(a, Rectangle(2.0, 0.0, 4.0, 3.0)), 6.0 / 18.0);
}

// A square and the same square rotated by 45 degrees share a regular octagon of area 2 (sqrt(2) -
// 1) side^2.
TEST(IntersectionArea, OfASquareAndItsRotatedCopyIsAnOctagon) {
  const double r = std::numbers::sqrt2;
  const Polygon square = Rectangle(-1.0, -1.0, 2.0, 2.0);
  const Polygon turned{{-r, 0.0}, {0.0, -r}, {r, 0.0}, {0.0, r}};
  EXPECT_NEAR(IntersectionArea(square, turned), 8.0 * (r - 1.0), 1e-12);
}

TEST(IntersectionOverUnion, OfPolygonsIsSymmetricBoundedAndOneForEqualPolygons) {
  RandomGeometry random(1);
  for (int i = 0; i < 200; ++i) {
    const Polygon a = RandomConvex(random);
    const Polygon b = RandomConvex(random);
    const double iou = IntersectionOverUnion(a, b);
    EXPECT_NEAR(iou, IntersectionOverUnion(b, a), 1e-12);
    EXPECT_GE(iou, 0.0);
    EXPECT_LT(iou, 1.0);
    EXPECT_EQ(IntersectionOverUnion(a, a), 1.0);
    EXPECT_LE(IntersectionArea(a, b), std::min(SignedArea(a), SignedArea(b)) + 1e-9);
  }
}

TEST(IntersectionOverUnion, OfPolygonsIsInvariantUnderACommonMotion) {
  RandomGeometry random(2);
  for (int i = 0; i < 100; ++i) {
    Polygon a = RandomConvex(random);
    Polygon b = RandomConvex(random);
    const double before = IntersectionOverUnion(a, b);
    const Eigen::Rotation2Dd turn(random.Number(-3.0, 3.0));
    const Eigen::Vector2d shift = random.Vector(500.0).head<2>();
    for (Polygon* const polygon : {&a, &b}) {
      for (Eigen::Vector2d& p : *polygon) {
        p = turn * p + shift;
      }
    }
    EXPECT_NEAR(IntersectionOverUnion(a, b), before, 1e-10);
  }
}

TEST(IntersectionOverUnion, OfConcentricEllipsesIsTheRatioOfTheirAreas) {
  const Ellipse outer{{100.0, 50.0}, Eigen::Vector2d(900.0, 400.0).asDiagonal()};
  const Ellipse inner{outer.center, 0.49 * outer.shape};
  EXPECT_NEAR(IntersectionOverUnion(outer.Polygon(), inner.Polygon()), 0.49, 1e-9);
}

TEST(IntersectionOverUnion, OfEmptySetsIsZero) {
  const Polygon a = Rectangle(0.0, 0.0, 4.0, 3.0);
  EXPECT_EQ(IntersectionOverUnion(a, Polygon()), 0.0);
  EXPECT_EQ(IntersectionOverUnion(Polygon(), a), 0.0);
  EXPECT_EQ(IntersectionOverUnion(Polygon(), Polygon()), 0.0);
  EXPECT_EQ(IntersectionOverUnion(a, Polygon{{0.0, 0.0}, {4.0, 3.0}}), 0.0);
  EXPECT_EQ(IntersectionOverUnion(Eigen::AlignedBox2d(), Eigen::AlignedBox2d()), 0.0);
}

TEST(IntersectionOverUnion, OfBoxesEqualsThatOfTheirPolygons) {
  RandomGeometry random(3);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d low_a = random.Vector(20.0).head<2>();
    const Eigen::Vector2d low_b = random.Vector(20.0).head<2>();
    const Eigen::Vector2d size_a(random.Number(1.0, 30.0), random.Number(1.0, 30.0));
    const Eigen::Vector2d size_b(random.Number(1.0, 30.0), random.Number(1.0, 30.0));
    const double of_polygons =
        IntersectionOverUnion(Rectangle(low_a.x(), low_a.y(), size_a.x(), size_a.y()),
                              Rectangle(low_b.x(), low_b.y(), size_b.x(), size_b.y()));
    const double of_boxes = IntersectionOverUnion(Eigen::AlignedBox2d(low_a, low_a + size_a),
                                                  Eigen::AlignedBox2d(low_b, low_b + size_b));
    EXPECT_NEAR(of_boxes, of_polygons, 1e-12);
  }
}

TEST(ClipToBox, KeepsThePartInsideTheBox) {
  const Eigen::AlignedBox2d box(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(640.0, 480.0));
  const Polygon inside = Rectangle(10.0, 10.0, 5.0, 5.0);
  EXPECT_EQ(ClipToBox(inside, box), inside);
  EXPECT_TRUE(ClipToBox(Rectangle(700.0, 10.0, 5.0, 5.0), box).empty());
  EXPECT_DOUBLE_EQ(SignedArea(ClipToBox(Rectangle(-10.0, -20.0, 30.0, 50.0), box)), 20.0 * 30.0);
  // The triangle's corner beyond x = 640 is cut off. The part outside has half of the triangle's
  // base and height.
  const Polygon triangle{{540.0, 100.0}, {740.0, 200.0}, {540.0, 300.0}};
  EXPECT_NEAR(SignedArea(ClipToBox(triangle, box)), 20000.0 * 0.75, 1e-9);
  EXPECT_TRUE(ClipToBox(inside, Eigen::AlignedBox2d()).empty());
}

TEST(ClipToHalfPlane, KeepsThePartBelowTheOffset) {
  const std::vector<Eigen::Vector2d> square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  EXPECT_DOUBLE_EQ(SignedArea(ClipToHalfPlane(square, {1.0, 0.0}, 0.5)), 1.0);
  EXPECT_DOUBLE_EQ(SignedArea(ClipToHalfPlane(square, {-2.0, 0.0}, -1.0)), 3.0);
  EXPECT_DOUBLE_EQ(SignedArea(ClipToHalfPlane(square, {1.0, 1.0}, 2.0)), 2.0);
  EXPECT_EQ(ClipToHalfPlane(square, {1.0, 0.0}, 5.0), square);
  EXPECT_TRUE(ClipToHalfPlane(square, {1.0, 0.0}, -1.0).empty());
}

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

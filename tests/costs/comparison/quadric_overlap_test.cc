// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "costs/object_cost_laws.h"
#include "geometry/polygon.h"

namespace hullslam {
namespace {

EllipseNumbers Circle(double x, double y, double radius) {
  EllipseNumbers circle;
  circle << x, y, radius * radius, 0.0, radius * radius;
  return circle;
}

std::vector<Eigen::Vector2d> Rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

double Intersection(const EllipseNumbers& ellipse, std::span<const Eigen::Vector2d> region) {
  // Solves iou = I / (E + R - I) for I.
  const double iou = EllipseOverlap(ellipse, region).iou;
  const double areas = ToEllipse(ellipse).Area() + SignedArea(region);
  return iou * areas / (1.0 + iou);
}

TEST(EllipseOverlap, ByHand) {
  const double pi = std::numbers::pi;
  const EllipseNumbers circle = Circle(10.0, 20.0, 2.0);
  // Squares around the circle and inside of it, rectangles over its right half and a quarter, and a
  // rectangle that is disjoint from it.
  EXPECT_NEAR(EllipseOverlap(circle, Rectangle(8, 18, 12, 22)).iou, pi / 4.0, 1e-12);
  EXPECT_NEAR(EllipseOverlap(circle, Rectangle(9, 19, 11, 21)).iou, 1.0 / pi, 1e-12);
  EXPECT_NEAR(Intersection(circle, Rectangle(10, 10, 30, 30)), 2.0 * pi, 1e-9);
  EXPECT_NEAR(Intersection(circle, Rectangle(10, 20, 30, 30)), pi, 1e-9);
  EXPECT_NEAR(EllipseOverlap(circle, Rectangle(13, 18, 15, 22)).iou, 0.0, 1e-12);
  EXPECT_LT(EllipseOverlap(circle, Rectangle(13, 18, 15, 22)).by_ellipse.norm(), 1e-12);
}

// The half plane x > 1 cuts off a circular segment with the area r^2 acos(1 / 2) - sqrt(3).
TEST(EllipseOverlap, SegmentByHand) {
  EXPECT_NEAR(Intersection(Circle(0.0, 0.0, 2.0), Rectangle(1, -9, 9, 9)),
              4.0 * std::numbers::pi / 3.0 - std::sqrt(3.0), 1e-9);
}

TEST(EllipseOverlap, AgreesWithTheOverlapOfPolygons) {
  RandomGeometry random(1);
  for (int i = 0; i < 50; ++i) {
    EllipseNumbers ellipse;
    const double yy = random.Number(50.0, 400.0);
    const double xx = random.Number(50.0, 400.0);
    ellipse << random.Number(-9, 9), random.Number(-9, 9), xx,
        random.Number(-0.8, 0.8) * std::sqrt(xx * yy), yy;
    const auto region = Rectangle(random.Number(-30, -2), random.Number(-30, -2),
                                  random.Number(2, 30), random.Number(2, 30));
    const auto polygon = ToEllipse(ellipse).Polygon(2000);
    EXPECT_NEAR(EllipseOverlap(ellipse, region).iou, IntersectionOverUnion(polygon, region), 1e-5);
  }
}

// The region has the shape of an L: a large square without a smaller square.
TEST(EllipseOverlap, RegionNeedNotBeConvex) {
  const std::vector<Eigen::Vector2d> corner = {{0, 0}, {8, 0}, {8, 3}, {3, 3}, {3, 8}, {0, 8}};
  RandomGeometry random(2);
  for (int i = 0; i < 20; ++i) {
    const EllipseNumbers circle =
        Circle(random.Number(0, 8), random.Number(0, 8), random.Number(0.5, 6.0));
    EXPECT_NEAR(
        Intersection(circle, corner),
        Intersection(circle, Rectangle(0, 0, 8, 8)) - Intersection(circle, Rectangle(3, 3, 8, 8)),
        1e-9);
  }
}

TEST(BoxOverlap, ByHand) {
  const Eigen::AlignedBox2d same(Eigen::Vector2d(8, 18), Eigen::Vector2d(12, 22));
  const Eigen::AlignedBox2d half(Eigen::Vector2d(10, 18), Eigen::Vector2d(14, 22));
  const Eigen::AlignedBox2d apart(Eigen::Vector2d(12, 18), Eigen::Vector2d(14, 22));
  const EllipseNumbers circle = Circle(10.0, 20.0, 2.0);
  EXPECT_NEAR(BoxOverlap(circle, same).iou, 1.0, 1e-12);
  EXPECT_NEAR(BoxOverlap(circle, half).iou, 1.0 / 3.0, 1e-12);
  EXPECT_EQ(BoxOverlap(circle, apart).iou, 0.0);
  EXPECT_TRUE(BoxOverlap(circle, apart).by_ellipse.isZero());
}

// Another object that is so near that the two projected ellipses overlap.
SeenEllipsoid Near(const SeenEllipsoid& state, RandomGeometry& random) {
  SeenEllipsoid moved = state;
  moved.ellipsoid.world_from_object.translation += random.Vector(0.05);
  moved.ellipsoid.half_axes *= random.Number(0.7, 1.3);
  return moved;
}

// The tolerances are larger here, because the second derivative of the area jumps where an arc
// passes a corner of the region.
void ExpectOverlapLaws(const OverlapCost& cost, const SeenEllipsoid& state,
                       RandomGeometry& random) {
  ExpectTrueObjectGradient(cost, state, 1e-4, 1e-6);
  ExpectObjectRigidInvariance(cost, state, random.Pose(2.0, 5.0));
}

TEST(OverlapCost, IsOneMinusTheOverlapInEitherOrder) {
  RandomGeometry random(3);
  const SeenEllipsoid state = RandomSeenEllipsoid(random);
  auto contour = ContourOf(state, 100);
  const double forward = ObjectResidualsOf(OverlapCost(kObjectCamera, contour, 0.5), state)[0];
  std::reverse(contour.begin(), contour.end());
  const double backward = ObjectResidualsOf(OverlapCost(kObjectCamera, contour, 0.5), state)[0];
  EXPECT_NEAR(forward, backward, 1e-9);
  EXPECT_LT(forward, 0.01);  // a polygon of 100 corners has less area than the ellipse
  EXPECT_GT(forward, 0.0);
}

TEST(OverlapCost, KeepsTheLaws) {
  RandomGeometry random(4);
  for (int i = 0; i < 30; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const OverlapCost cost(kObjectCamera, ContourOf(Near(state, random), 12), 0.2);
    ExpectOverlapLaws(cost, state, random);
  }
}

TEST(OverlapCost, OfBoxesKeepsTheLaws) {
  RandomGeometry random(5);
  for (int i = 0; i < 30; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& point : ContourOf(Near(state, random), 50)) {
      box.extend(point);
    }
    const OverlapCost cost(kObjectCamera, box, 0.2);
    ExpectOverlapLaws(cost, state, random);
  }
}

TEST(OverlapCost, IsNotDefinedUnlessInFront) {
  ExpectUndefinedUnlessInFront(OverlapCost(kObjectCamera, Rectangle(0, 0, 100, 100), 1.0));
}

TEST(OverlapCost, HasItsRowInTheTable) {
  ExpectKind(ObjectResidual::kOverlap, "overlap", false,
             {ObjectPrimitive::kHull, ObjectPrimitive::kContour, ObjectPrimitive::kBox,
              ObjectPrimitive::kConic, ObjectPrimitive::kBoxEllipse});
  EXPECT_NEAR(SizeOfSomeError(ObjectResidual::kOverlap), 1.0 - 400.0 / (21.5 * 21.5), 1e-12);
}

}  // namespace
}  // namespace hullslam

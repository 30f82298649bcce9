// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/shape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "hullslam/util/check.h"
#include "synthetic/tests/implicit_shape.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

std::vector<Shape> AllShapes() {
  return {Shape::Box({0.3, 0.2, 0.1}),
          Shape::Ellipsoid({0.3, 0.2, 0.1}),
          Shape::Superquadric({0.1, 0.2, 0.15}, 0.4, 0.7),
          Shape::Cylinder(0.05, 0.12),
          Shape::Torus(0.1, 0.02),
          Shape::Revolved({{0.0, 0.3},
                           {0.05, 0.3},
                           {0.1, 0.4},
                           {0.07, 0.5},
                           {0.05, 0.5},
                           {0.06, 0.4},
                           {0.0, 0.35}})};
}

TEST(Shape, VerticesAreOnTheSurfaceAndItsExtentsAreTight) {
  for (const Shape& shape : AllShapes()) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& vertex : Tessellate(shape).vertices) {
      box.extend(vertex);
      if (shape.kind !=
          ShapeKind::kCylinder) {  // the discs at its ends also have vertices inside the disc
        EXPECT_NEAR(Implicit(shape, vertex), 0.0, 1e-9);
      }
    }
    EXPECT_TRUE(box.max().isApprox(shape.half, 1e-9)) << box.max().transpose();
    EXPECT_TRUE(box.min().isApprox(-shape.half, 1e-9)) << box.min().transpose();
  }
}

TEST(Shape, ImplicitIsNegativeInsideAndPositiveOutside) {
  for (const Shape& shape : AllShapes()) {
    const Vector3d on_x(shape.half.x(), 0.0, 0.0);
    EXPECT_NEAR(Implicit(shape, on_x), 0.0, 1e-9);
    EXPECT_LT(Implicit(shape, 0.95 * on_x), 0.0);
    EXPECT_GT(Implicit(shape, 1.05 * on_x), 0.0);
  }
  EXPECT_GT(Implicit(Shape::Torus(0.1, 0.02), Vector3d::Zero()), 0.0);
}

TEST(Shape, MatchesHandComputedValues) {
  EXPECT_DOUBLE_EQ(Implicit(Shape::Box({1.0, 2.0, 4.0}), {0.5, 3.0, 4.0}), 0.5);
  EXPECT_DOUBLE_EQ(Implicit(Shape::Ellipsoid({1.0, 2.0, 4.0}), {0.0, 6.0, 16.0}), 4.0);
  EXPECT_DOUBLE_EQ(Implicit(Shape::Cylinder(0.5, 2.0), {0.6, 0.8, 1.0}), 1.0);
  EXPECT_DOUBLE_EQ(Implicit(Shape::Torus(3.0, 1.0), {0.0, 0.0, 5.0}), 1.0);
  // With both exponents 1 a superquadric is an ellipsoid.
  EXPECT_NEAR(Implicit(Shape::Superquadric({1.0, 2.0, 4.0}, 1.0, 1.0), {0.0, 6.0, 16.0}), 4.0,
              1e-12);
}

TEST(Shape, NormalIsTheGradient) {
  for (const Shape& shape : AllShapes()) {
    if (shape.kind == ShapeKind::kBox || shape.kind == ShapeKind::kCylinder ||
        shape.kind == ShapeKind::kRevolved) {
      continue;  // not smooth
    }
    const TriangleMesh mesh = Tessellate(shape);
    for (size_t i = 0; i < mesh.vertices.size(); i += 97) {
      const Vector3d& point = mesh.vertices[i];
      Vector3d gradient;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d step = 1e-6 * Vector3d::Unit(axis);
        gradient[axis] = Implicit(shape, point + step) - Implicit(shape, point - step);
      }
      EXPECT_LT((shape.Normal(point) - gradient.normalized()).norm(), 1e-3) << point.transpose();
    }
  }
}

TEST(Shape, NormalsOfFlatSidesPointOutwards) {
  EXPECT_EQ(Shape::Box({1.0, 2.0, 0.5}).Normal({0.2, -2.0, 0.1}), Vector3d(0.0, -1.0, 0.0));
  EXPECT_EQ(Shape::Cylinder(0.5, 2.0).Normal({0.1, 0.1, -2.0}), Vector3d(0.0, 0.0, -1.0));
  EXPECT_TRUE(Shape::Cylinder(0.5, 2.0).Normal({0.3, 0.4, 1.0}).isApprox(Vector3d(0.6, 0.8, 0.0)));
}

TEST(Shape, NormalsOfASolidOfRevolutionPointOutOfTheMaterial) {
  // An open cup with an outer radius of 0.5, an inner one of 0.4, and a floor of 0.2.
  const Shape cup =
      Shape::Revolved({{0.0, 0.0}, {0.5, 0.0}, {0.5, 2.0}, {0.4, 2.0}, {0.4, 0.2}, {0.0, 0.2}});
  EXPECT_EQ(cup.half, Vector3d(0.5, 0.5, 1.0));
  EXPECT_TRUE(cup.Normal({0.3, 0.4, 0.1}).isApprox(Vector3d(0.6, 0.8, 0.0)));
  EXPECT_TRUE(cup.Normal({0.24, 0.32, 0.1}).isApprox(Vector3d(-0.6, -0.8, 0.0)));
  EXPECT_TRUE(cup.Normal({0.2, 0.0, -1.0}).isApprox(Vector3d(0.0, 0.0, -1.0)));
  EXPECT_TRUE(cup.Normal({0.0, 0.0, -0.8}).isApprox(Vector3d(0.0, 0.0, 1.0)));
  EXPECT_TRUE(cup.Normal({0.0, 0.45, 1.0}).isApprox(Vector3d(0.0, 0.0, 1.0)));
  for (const Vector3d& vertex : Tessellate(cup).vertices) {
    EXPECT_NEAR(Implicit(cup, vertex), 0.0, 1e-9);
  }
}

TEST(Shape, AProfileMustBeginAndEndAtTheAxis) {
  EXPECT_THROW(Shape::Revolved({}), CheckError);
  EXPECT_THROW(Shape::Revolved({{0.0, 0.0}, {0.0, 1.0}}), CheckError);
  EXPECT_THROW(Shape::Revolved({{0.1, 0.0}, {0.5, 0.0}, {0.0, 1.0}}), CheckError);
  EXPECT_THROW(Shape::Revolved({{0.0, 0.0}, {0.5, 0.0}, {0.1, 1.0}}), CheckError);
  EXPECT_THROW(Shape::Revolved({{0.0, 0.0}, {-0.5, 0.0}, {0.0, 1.0}}), CheckError);
}

TEST(Tessellate, StaysNearTheEllipsoidBetweenVertices) {
  const Vector3d half(0.4, 0.25, 0.1);
  const TriangleMesh mesh = Tessellate(Shape::Ellipsoid(half));
  for (const auto& triangle : mesh.triangles) {
    const Vector3d middle =
        (mesh.vertices[triangle[0]] + mesh.vertices[triangle[1]] + mesh.vertices[triangle[2]]) /
        3.0;
    const double inside = (middle.cwiseQuotient(half).norm() - 1.0) * half.maxCoeff();
    EXPECT_LE(inside, 1e-12);
    EXPECT_GT(inside, -1e-4);
  }
}

}  // namespace
}  // namespace hullslam::synthetic

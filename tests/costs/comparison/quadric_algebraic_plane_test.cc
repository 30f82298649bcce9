// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_algebraic_plane.h"

#include <gtest/gtest.h>

#include "costs/object_cost_laws.h"

namespace hullslam {
namespace {

TEST(AlgebraicPlaneCost, ByHand) {
  // The line x = 820 is the plane x = z: its distance from the centre (0, 0, 1) is 1 / sqrt(2), so
  // h^2 - d^2 = 0.36 - 0.5. The line x = 320 goes through the centre.
  const std::vector<SilhouetteLine> lines = {{{{1.0, 0.0}, -820.0}, false},
                                             {{{1.0, 0.0}, -320.0}, false}};
  const AlgebraicPlaneCost cost(kObjectCamera, lines, 0.1);
  const Eigen::VectorXd residuals = ObjectResidualsOf(cost, SphereAhead());
  EXPECT_NEAR(residuals[0], -1.4, 1e-9);
  EXPECT_NEAR(residuals[1], 3.6, 1e-9);
}

// Compares with pi^T Q* pi, computed from the full matrices, where pi = P^T l has a unit normal.
TEST(AlgebraicPlaneCost, IsThePapersResidual) {
  RandomGeometry random(1);
  const SeenEllipsoid state = RandomSeenEllipsoid(random);
  const std::vector<SilhouetteLine> lines = TangentsOf(RandomSeenEllipsoid(random), 8);
  const AlgebraicPlaneCost cost(kObjectCamera, lines, 1.0);
  const Eigen::VectorXd residuals = ObjectResidualsOf(cost, state);
  const Eigen::Matrix3d k = kObjectCamera.Matrix();
  Eigen::Matrix4d z = Eigen::Matrix4d::Identity();
  z.topRows<3>() = state.ellipsoid.world_from_object.ToMatrix();
  Eigen::Vector4d squares(0.0, 0.0, 0.0, -1.0);
  squares.head<3>() = state.ellipsoid.half_axes.cwiseAbs2();
  const Eigen::Matrix4d dual = z * squares.asDiagonal() * z.transpose();
  for (int i = 0; i < 8; ++i) {
    Eigen::Vector4d plane = (k * state.cam_from_world.ToMatrix()).transpose() *
                            lines[static_cast<size_t>(i)].line.Homogeneous();
    plane /= plane.head<3>().norm();
    EXPECT_NEAR(residuals[i], plane.dot(dual * plane), 1e-9);
  }
}

TEST(AlgebraicPlaneCost, IsZeroForEveryTangent) {
  RandomGeometry random(2);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const AlgebraicPlaneCost cost(kObjectCamera, TangentsOf(state, 16), 1.0);
    EXPECT_LT(ObjectResidualsOf(cost, state).norm(), 1e-9);
  }
}

TEST(AlgebraicPlaneCost, KeepsTheLaws) {
  RandomGeometry random(3);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const AlgebraicPlaneCost cost(kObjectCamera, TangentsOf(RandomSeenEllipsoid(random), 12), 0.3);
    ExpectObjectCostLaws(cost, state, random);
  }
}

TEST(AlgebraicPlaneCost, OneSidedIsZeroWhereTheObjectReachesThePlane) {
  RandomGeometry random(4);
  for (int i = 0; i < 10; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    // A line moved by -500 px has the object beyond it, one moved by -3 px cuts the object, and the
    // object does not reach one moved by 3 px.
    for (const double outwards : {-500.0, -3.0, 3.0}) {
      std::vector<SilhouetteLine> lines = TangentsOf(state, 16);
      for (SilhouetteLine& line : lines) {
        line.is_one_sided = true;
        line.line.offset -= outwards;
      }
      const AlgebraicPlaneCost cost(kObjectCamera, lines, 1.0);
      const Eigen::VectorXd residuals = ObjectResidualsOf(cost, state);
      EXPECT_EQ(residuals.isZero(0.0), outwards < 0.0) << outwards;
      EXPECT_TRUE((residuals.array() <= 0.0).all());
      ExpectTrueObjectGradient(cost, state);
    }
  }
}

TEST(AlgebraicPlaneCost, IsNotDefinedUnlessInFront) {
  ExpectUndefinedUnlessInFront(
      AlgebraicPlaneCost(kObjectCamera, TangentsOf(SphereAhead(), 8), 1.0));
}

TEST(AlgebraicPlaneCost, HasItsRowInTheTable) {
  ExpectKind(ObjectResidual::kAlgebraicPlane, "algebraic_plane", true,
             {kAllPrimitives.begin(), kAllPrimitives.end()});
  EXPECT_NEAR(SizeOfSomeError(ObjectResidual::kAlgebraicPlane), 2.0 * 20.0 * 1.5 * 1e-4, 1e-12);
}

}  // namespace
}  // namespace hullslam

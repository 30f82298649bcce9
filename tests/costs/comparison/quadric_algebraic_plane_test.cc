// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_algebraic_plane.h"

#include <gtest/gtest.h>

#include "costs/comparison/plane_cost_laws.h"

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

TEST(AlgebraicPlaneCost, KeepsTheLaws) { ExpectPlaneCostLaws<AlgebraicPlaneCost>(); }

TEST(AlgebraicPlaneCost, HasItsRowInTheTable) {
  ExpectKind(ObjectResidual::kAlgebraicPlane, "algebraic_plane", true,
             {kAllPrimitives.begin(), kAllPrimitives.end()});
  EXPECT_NEAR(SizeOfSomeError(ObjectResidual::kAlgebraicPlane), 2.0 * 20.0 * 1.5 * 1e-4, 1e-12);
}

}  // namespace
}  // namespace hullslam

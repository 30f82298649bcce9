// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_relative_plane.h"

#include <gtest/gtest.h>

#include "costs/comparison/plane_cost_laws.h"

namespace hullslam {
namespace {

TEST(RelativePlaneCost, ByHand) {
  // A sphere of radius 1.2 at (0, 0, 2). The line x = 820 is the plane x = z: its distance from the
  // centre is 2 / sqrt(2), so (h^2 - d^2) / z^2 = (1.44 - 2) / 4. The line x = 320 goes through the
  // centre: 1.44 / 4.
  SeenEllipsoid state;
  state.ellipsoid.world_from_object.translation = {0.0, 0.0, 2.0};
  state.ellipsoid.half_axes.setConstant(1.2);
  const std::vector<SilhouetteLine> lines = {{{{1.0, 0.0}, -820.0}, false},
                                             {{{1.0, 0.0}, -320.0}, false}};
  const RelativePlaneCost cost(kObjectCamera, lines, 0.1);
  const Eigen::VectorXd residuals = ObjectResidualsOf(cost, state);
  EXPECT_NEAR(residuals[0], -1.4, 1e-9);
  EXPECT_NEAR(residuals[1], 3.6, 1e-9);
}

// Also while z changes: the quotient is taken at the state, not at a start.
TEST(RelativePlaneCost, IsTheAlgebraicResidualOverTheSquaredDepth) {
  RandomGeometry random(1);
  const std::vector<SilhouetteLine> lines = TangentsOf(RandomSeenEllipsoid(random), 8);
  const RelativePlaneCost relative(kObjectCamera, lines, 0.3);
  const AlgebraicPlaneCost algebraic(kObjectCamera, lines, 0.3);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    const double depth = (state.cam_from_world * state.ellipsoid.world_from_object).translation.z();
    EXPECT_LT(
        (depth * depth * ObjectResidualsOf(relative, state) - ObjectResidualsOf(algebraic, state))
            .norm(),
        1e-12 * ObjectResidualsOf(algebraic, state).norm());
  }
}

TEST(RelativePlaneCost, KeepsTheLaws) { ExpectPlaneCostLaws<RelativePlaneCost>(); }

TEST(RelativePlaneCost, HasItsRowInTheTable) {
  ExpectKind(ObjectResidual::kRelativePlane, "relative_plane", true,
             {kAllPrimitives.begin(), kAllPrimitives.end()});
  EXPECT_NEAR(SizeOfSomeError(ObjectResidual::kRelativePlane), 2.0 * 20.0 * 1.5 / 250000.0, 1e-12);
}

}  // namespace
}  // namespace hullslam

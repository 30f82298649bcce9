// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "costs/object_cost_laws.h"

namespace hullslam {

// A one-sided line is met where the object reaches its plane or lies beyond it.
template <typename Cost>
void ExpectOneSidedLinesAreMet(const SeenEllipsoid& state) {
  // A line moved by -500 px has the object beyond it, one moved by -3 px cuts the object, and the
  // object does not reach one moved by 3 px.
  for (const double outwards : {-500.0, -3.0, 3.0}) {
    std::vector<SilhouetteLine> lines = TangentsOf(state, 16);
    for (SilhouetteLine& line : lines) {
      line.is_one_sided = true;
      line.line.offset -= outwards;
    }
    const Cost cost(kObjectCamera, lines, 1.0);
    const Eigen::VectorXd residuals = ObjectResidualsOf(cost, state);
    EXPECT_EQ(residuals.isZero(0.0), outwards < 0.0) << outwards;
    EXPECT_TRUE((residuals.array() <= 0.0).all());
    ExpectTrueObjectGradient(cost, state);
  }
}

// The laws of the residuals of planes: gradient, rigid motion, zero for every tangent, one-sided
// lines, and where they are not defined.
template <typename Cost>
void ExpectPlaneCostLaws() {
  RandomGeometry random(2);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    EXPECT_LT(ObjectResidualsOf(Cost(kObjectCamera, TangentsOf(state, 16), 1.0), state).norm(),
              1e-9);
    ExpectObjectCostLaws(Cost(kObjectCamera, TangentsOf(RandomSeenEllipsoid(random), 12), 0.3),
                         state, random);
    ExpectOneSidedLinesAreMet<Cost>(state);
  }
  ExpectUndefinedUnlessInFront(Cost(kObjectCamera, TangentsOf(SphereAhead(), 8), 1.0));
}

}  // namespace hullslam

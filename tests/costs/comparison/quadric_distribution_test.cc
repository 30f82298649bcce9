// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_distribution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "costs/object_cost_laws.h"

namespace hullslam {
namespace {

constexpr std::array kDistances = {DistributionDistance::kWasserstein,
                                   DistributionDistance::kBhattacharyya};

Ellipse OutlineEllipse(const SeenEllipsoid& state) {
  const ObjectBlocks blocks(state);
  const QuadricInCamera quadric(blocks.Pointers().data());
  return ToEllipse(EllipseProjection(kObjectCamera, quadric).numbers());
}

// The projected ellipse has the half axes 375 and 300 px and the centre (320, 240), the measured
// one 370 and 310 px and (317, 244). If the axes are parallel, the squared Wasserstein distance is
// the sum of the squared differences of these numbers.
TEST(DistributionCost, WassersteinByHand) {
  Ellipse measured;
  measured.center = {317.0, 244.0};
  measured.shape = Eigen::Vector2d(370.0 * 370.0, 310.0 * 310.0).asDiagonal();
  const DistributionCost cost(kObjectCamera, measured, 10.0);
  EXPECT_NEAR(ObjectResidualsOf(cost, SphereAhead())[0], (9.0 + 16.0 + 25.0 + 100.0) / 10.0, 1e-7);
}

TEST(DistributionCost, BhattacharyyaByHand) {
  Ellipse measured;
  measured.center = {320.0 + 375.0, 240.0};
  measured.shape = Eigen::Vector2d(375.0 * 375.0, 300.0 * 300.0).asDiagonal();
  const DistributionCost shifted(kObjectCamera, measured, 1.0,
                                 DistributionDistance::kBhattacharyya);
  EXPECT_NEAR(ObjectResidualsOf(shifted, SphereAhead())[0], 1.0 / 8.0, 1e-9);
  measured.center = {320.0, 240.0};
  measured.shape *= 4.0;
  const DistributionCost larger(kObjectCamera, measured, 1.0, DistributionDistance::kBhattacharyya);
  EXPECT_NEAR(ObjectResidualsOf(larger, SphereAhead())[0], 0.5 * std::log(2.5 * 2.5 / 4.0), 1e-9);
}

TEST(DistributionCost, IsZeroForTheOutlineAndPositiveForOthers) {
  RandomGeometry random(1);
  for (const DistributionDistance distance : kDistances) {
    for (int i = 0; i < 20; ++i) {
      const SeenEllipsoid state = RandomSeenEllipsoid(random);
      const DistributionCost cost(kObjectCamera, OutlineEllipse(state), 1.0, distance);
      EXPECT_NEAR(ObjectResidualsOf(cost, state)[0], 0.0, 1e-7);
      EXPECT_GT(ObjectResidualsOf(cost, RandomSeenEllipsoid(random))[0], 1e-3);
    }
  }
}

TEST(DistributionCost, KeepsTheLaws) {
  RandomGeometry random(2);
  for (const DistributionDistance distance : kDistances) {
    for (int i = 0; i < 20; ++i) {
      const Ellipse measured = OutlineEllipse(RandomSeenEllipsoid(random));
      const DistributionCost cost(kObjectCamera, measured, 7.0, distance);
      ExpectObjectCostLaws(cost, RandomSeenEllipsoid(random), random);
    }
  }
}

TEST(DistributionCost, IsNotDefinedUnlessInFront) {
  for (const DistributionDistance distance : kDistances) {
    ExpectUndefinedUnlessInFront(
        DistributionCost(kObjectCamera, OutlineEllipse(SphereAhead()), 1.0, distance));
  }
}

TEST(DistributionCost, TheWassersteinDistanceIsAlsoAFunction) {
  Ellipse a;
  a.shape = Eigen::Vector2d(9.0, 4.0).asDiagonal();
  Ellipse b;
  b.center = {3.0, -4.0};
  b.shape = Eigen::Vector2d(25.0, 16.0).asDiagonal();
  EXPECT_NEAR(SquaredWasserstein(a, b), 25.0 + 4.0 + 4.0, 1e-9);
  EXPECT_NEAR(SquaredWasserstein(b, a), SquaredWasserstein(a, b), 1e-9);
  EXPECT_NEAR(SquaredWasserstein(a, a), 0.0, 1e-9);
}

TEST(DistributionCost, HasItsRowInTheTable) {
  ExpectKind(ObjectResidual::kDistribution, "distribution", false,
             {ObjectPrimitive::kConic, ObjectPrimitive::kBoxEllipse});
  EXPECT_NEAR(SizeOfSomeError(ObjectResidual::kDistribution), 2.25, 1e-12);
}

}  // namespace
}  // namespace hullslam

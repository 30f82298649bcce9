// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_box_bounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "costs/object_cost_laws.h"
#include "costs/residual_kind.h"

namespace hullslam {
namespace {

constexpr std::array<bool, 4> kWhole = {false, false, false, false};

EllipseNumbers EllipseAt(const SeenEllipsoid& state) {
  const ObjectBlocks blocks(state);
  const QuadricInCamera quadric(blocks.Pointers().data());
  return EllipseProjection(kObjectCamera, quadric).numbers();
}

Eigen::AlignedBox2d BoxOf(const SeenEllipsoid& state) {
  return ToEllipse(EllipseAt(state)).Bounds();
}

// A circle of radius 100 px at the origin, and a box that is cut on the right at x = 60: the part
// of the circle inside still has its uppermost point, so only the right bound changes.
TEST(ClippedBound, ByHand) {
  EllipseNumbers circle;
  circle << 0.0, 0.0, 1e4, 0.0, 1e4;
  Eigen::AlignedBox2d box(Eigen::Vector2d(-100.0, -100.0), Eigen::Vector2d(60.0, 100.0));
  std::array<bool, 4> is_cut = kWhole;
  EXPECT_NEAR(ClippedBound(circle, box, is_cut, kRight).value, 100.0, 1e-9);
  is_cut[kRight] = true;
  EXPECT_NEAR(ClippedBound(circle, box, is_cut, kRight).value, 60.0, 1e-9);
  EXPECT_TRUE(ClippedBound(circle, box, is_cut, kRight).by_ellipse.isZero());
  EXPECT_NEAR(ClippedBound(circle, box, is_cut, kTop).value, -100.0, 1e-9);
  // Cut at x = -60, the uppermost point of what is left is where the circle crosses this line.
  box.max().x() = -60.0;
  EXPECT_NEAR(ClippedBound(circle, box, is_cut, kTop).value, -80.0, 1e-9);
  EXPECT_NEAR(ClippedBound(circle, box, is_cut, kBottom).value, 80.0, 1e-9);
  // Beyond the line there is nothing left, so the whole circle counts.
  box.max().x() = -160.0;
  EXPECT_NEAR(ClippedBound(circle, box, is_cut, kTop).value, -100.0, 1e-9);
}

// The circle above, cut at x = -60 on the right and at y = -50 at the top. It crosses the right
// line at (-60, -80) too, but this point is beyond the line at the top.
TEST(ClippedBound, CrossingsBeyondAnotherCutSideDoNotCount) {
  EllipseNumbers circle;
  circle << 0.0, 0.0, 1e4, 0.0, 1e4;
  const Eigen::AlignedBox2d box(Eigen::Vector2d(-100.0, -50.0), Eigen::Vector2d(-60.0, 100.0));
  const std::array<bool, 4> is_cut = {false, true, true, false};
  ASSERT_TRUE(is_cut[kTop] && is_cut[kRight]);
  EXPECT_NEAR(ClippedBound(circle, box, is_cut, kTop).value, -50.0, 1e-9);
  EXPECT_NEAR(ClippedBound(circle, box, is_cut, kRight).value, -60.0, 1e-9);
  EXPECT_NEAR(ClippedBound(circle, box, is_cut, kBottom).value, 80.0, 1e-9);
  EXPECT_NEAR(ClippedBound(circle, box, is_cut, kLeft).value, -100.0, 1e-9);
}

TEST(BoxBoundsCost, IsTheDifferenceOfTheBounds) {
  // The projected ellipse of the sphere has the half axes 375 and 300 px and the centre (320, 240).
  const Eigen::AlignedBox2d box(Eigen::Vector2d(-60.0, -57.0), Eigen::Vector2d(690.0, 545.0));
  const BoxBoundsCost cost(kObjectCamera, box, kWhole, 2.0);
  const Eigen::VectorXd residuals = ObjectResidualsOf(cost, SphereAhead());
  EXPECT_NEAR(residuals[kLeft], 0.5 * (-55.0 + 60.0), 1e-6);
  EXPECT_NEAR(residuals[kTop], 0.5 * (-60.0 + 57.0), 1e-6);
  EXPECT_NEAR(residuals[kRight], 0.5 * (695.0 - 690.0), 1e-6);
  EXPECT_NEAR(residuals[kBottom], 0.5 * (540.0 - 545.0), 1e-6);
}

TEST(BoxBoundsCost, AnObjectThatTheBorderCutsHasNoResidualBeyondIt) {
  Eigen::AlignedBox2d box = BoxOf(SphereAhead());
  box.min().x() = 0.0;  // the border of the image
  const BoxBoundsCost whole(kObjectCamera, box, kWhole, 1.0);
  EXPECT_NEAR(ObjectResidualsOf(whole, SphereAhead())[kLeft], -55.0, 1e-6);
  const BoxBoundsCost cut(kObjectCamera, box, {true, false, false, false}, 1.0);
  EXPECT_NEAR(ObjectResidualsOf(cut, SphereAhead()).norm(), 0.0, 1e-6);
}

TEST(BoxBoundsCost, KeepsTheLaws) {
  RandomGeometry random(5);
  for (int i = 0; i < 20; ++i) {
    const BoxBoundsCost cost(kObjectCamera, BoxOf(RandomSeenEllipsoid(random)), kWhole, 3.0);
    ExpectObjectCostLaws(cost, RandomSeenEllipsoid(random), random);
  }
}

// Each side is cut by a fifth of the box, so that other bounds are where the ellipse crosses it.
TEST(BoxBoundsCost, KeepsTheLawsWhereItIsCut) {
  RandomGeometry random(6);
  for (int i = 0; i < 20; ++i) {
    const SeenEllipsoid state = RandomSeenEllipsoid(random);
    for (const BoxSide side : {kLeft, kTop, kRight, kBottom}) {
      Eigen::AlignedBox2d box = BoxOf(state);
      const Eigen::Vector2d fifth = 0.2 * box.sizes();
      if (side == kLeft) box.min().x() += fifth.x();
      if (side == kTop) box.min().y() += fifth.y();
      if (side == kRight) box.max().x() -= fifth.x();
      if (side == kBottom) box.max().y() -= fifth.y();
      std::array<bool, 4> is_cut = kWhole;
      is_cut[side] = true;
      const BoxBoundsCost cost(kObjectCamera, box, is_cut, 3.0);
      EXPECT_NEAR(ObjectResidualsOf(cost, state)[side], 0.0, 1e-6);
      // Where an extreme point leaves the part that is left, the second derivative jumps, so near
      // it the numeric derivative is less precise.
      ExpectTrueObjectGradient(cost, state, 1e-3);
      ExpectObjectRigidInvariance(cost, state, random.Pose(2.0, 5.0));
    }
  }
}

TEST(BoxBoundsCost, OneSidedLinesTellWhatIsCut) {
  Detection detection;
  detection.primitive = ObjectPrimitive::kBox;
  detection.box = BoxOf(SphereAhead());
  detection.box.max().y() = 480.0;
  detection.lines = {{{{0.0, 1.0}, -480.0}, true}, {{{1.0, 0.0}, -695.0}, false}};
  const auto cost =
      MakeObjectCost(ObjectResidual::kBoxBounds, kObjectCamera, detection, detection.lines, 1.0);
  EXPECT_NEAR(ObjectResidualsOf(*cost, SphereAhead()).norm(), 0.0, 1e-6);
}

TEST(BoxBoundsCost, IsNotDefinedUnlessInFront) {
  ExpectUndefinedUnlessInFront(BoxBoundsCost(kObjectCamera, BoxOf(SphereAhead()), kWhole, 1.0));
}

TEST(BoxBoundsCost, HasItsRowInTheTable) {
  ExpectKind(ObjectResidual::kBoxBounds, "box_bounds", false, {ObjectPrimitive::kBox});
  EXPECT_NEAR(SizeOfSomeError(ObjectResidual::kBoxBounds), 1.5, 1e-12);
}

}  // namespace
}  // namespace hullslam

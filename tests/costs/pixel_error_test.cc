// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/pixel_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "costs/make_object_cost.h"
#include "costs/object_cost_laws.h"

namespace hullslam {
namespace {

// A small, distant sphere. The radius of its projection is r = 500 * 0.2 / sqrt(25 - 0.04) px.
SeenEllipsoid SmallSphere() {
  SeenEllipsoid state;
  state.ellipsoid.world_from_object.translation = {0.0, 0.0, 5.0};
  state.ellipsoid.half_axes.setConstant(0.2);
  return state;
}

constexpr PinholeCamera kSquare{.fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};

double SizeOf(ObjectResidual residual, double error_px) {
  const SeenEllipsoid state = SmallSphere();
  return ResidualOfPixelError(residual, kSquare, state.cam_from_world, state.ellipsoid, error_px)
      .value();
}

TEST(ResidualOfPixelError, ByHand) {
  const double radius = 100.0 / std::sqrt(25.0 - 0.04);
  EXPECT_NEAR(SizeOf(ObjectResidual::kTangent, 1.5), 1.5, 1e-12);
  EXPECT_NEAR(SizeOf(ObjectResidual::kAlgebraicPlane, 1.5), 2.0 * radius * 1.5 * 1e-4, 1e-12);
  EXPECT_NEAR(SizeOf(ObjectResidual::kAlgebraicPoint, 1.5), 3.0 / radius, 1e-12);
  EXPECT_NEAR(SizeOf(ObjectResidual::kDistribution, 1.5), 2.25, 1e-12);
  EXPECT_NEAR(SizeOf(ObjectResidual::kOverlap, 1.5), 1.0 - std::pow(radius / (radius + 1.5), 2),
              1e-12);
}

// The result agrees with the residuals of an outline that is larger by this error.
TEST(ResidualOfPixelError, IsTheSizeOfTheResiduals) {
  const double radius = 100.0 / std::sqrt(25.0 - 0.04);
  const double error_px = 0.2;
  Ellipse wrong;
  wrong.center = {320.0, 240.0};
  wrong.shape = (radius + error_px) * (radius + error_px) * Eigen::Matrix2d::Identity();
  const std::vector<Eigen::Vector2d> contour = wrong.Polygon(720);
  Detection detection;
  detection.contour = wrong.Polygon(720);
  detection.hull = contour;
  detection.ellipse = wrong;
  detection.lines = {{{{1.0, 0.0}, -320.0 - radius - error_px}, false},
                     {{{0.6, 0.8}, -0.6 * 320.0 - 0.8 * 240.0 - radius - error_px}, false}};
  for (const auto& [residual, primitive] :
       {std::pair(ObjectResidual::kTangent, ObjectPrimitive::kSupport),
        {ObjectResidual::kAlgebraicPlane, ObjectPrimitive::kSupport},
        {ObjectResidual::kAlgebraicPoint, ObjectPrimitive::kContour},
        {ObjectResidual::kOverlap, ObjectPrimitive::kHull}}) {
    detection.primitive = primitive;
    const auto cost = MakeObjectCost(residual, kSquare, detection, detection.lines, 1.0);
    const double size = ObjectResidualsOf(*cost, SmallSphere()).cwiseAbs().mean();
    EXPECT_NEAR(size / SizeOf(residual, error_px), 1.0, 0.03) << NameOf(residual);
  }
  wrong.shape = radius * radius * Eigen::Matrix2d::Identity();
  wrong.center.x() += error_px;
  detection.primitive = ObjectPrimitive::kConic;
  detection.ellipse = wrong;
  const auto cost =
      MakeObjectCost(ObjectResidual::kDistribution, kSquare, detection, detection.lines, 1.0);
  EXPECT_NEAR(
      ObjectResidualsOf(*cost, SmallSphere())[0] / SizeOf(ObjectResidual::kDistribution, error_px),
      1.0, 1e-6);
}

TEST(ResidualOfPixelError, IsNothingUnlessInFront) {
  SeenEllipsoid state = SmallSphere();
  for (const double z : {-5.0, 0.0, 0.2}) {
    state.ellipsoid.world_from_object.translation.z() = z;
    EXPECT_FALSE(ResidualOfPixelError(ObjectResidual::kTangent, kSquare, state.cam_from_world,
                                      state.ellipsoid, 1.0)
                     .has_value())
        << z;
  }
}

}  // namespace
}  // namespace hullslam

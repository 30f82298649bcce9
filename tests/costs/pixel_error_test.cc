// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/pixel_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "costs/object_cost_laws.h"
#include "costs/residual_kind.h"

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
  EXPECT_NEAR(SizeOf(ObjectResidual::kAlgebraicPlane, 1.5), 2.0 * radius * 1.5 * 1e-4, 1e-12);
  EXPECT_NEAR(SizeOf(ObjectResidual::kRelativePlane, 1.5), 2.0 * radius * 1.5 / 250000.0, 1e-12);
  EXPECT_NEAR(SizeOf(ObjectResidual::kAlgebraicPoint, 1.5), 3.0 / radius, 1e-12);
}

// The mean residual of the sphere if this ellipse is measured.
double MeanResidual(ObjectResidual residual, const Ellipse& measured) {
  Detection detection;
  detection.primitive = KindOf(residual).primitives.front();
  detection.hull = measured.Polygon(720);
  detection.contour = detection.hull;
  detection.ellipse = measured;
  detection.box = measured.Bounds();
  for (const Eigen::Vector2d& normal : {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.6, 0.8)}) {
    const double offset = -normal.dot(measured.center) - measured.HalfExtent(normal);
    detection.lines.push_back({{normal, offset}, false});
  }
  const auto cost = MakeObjectCost(residual, kSquare, detection, detection.lines, 1.0);
  return ObjectResidualsOf(*cost, SmallSphere()).cwiseAbs().mean();
}

// The result agrees with the residuals of an outline that is larger by this error or, for a
// residual that compares two ellipses, is shifted by it.
TEST(ResidualOfPixelError, IsTheSizeOfTheResiduals) {
  const double radius = 100.0 / std::sqrt(25.0 - 0.04);
  const double error_px = 0.2;
  Ellipse larger;
  larger.center = {320.0, 240.0};
  larger.shape = (radius + error_px) * (radius + error_px) * Eigen::Matrix2d::Identity();
  Ellipse shifted;
  shifted.center = {320.0 + error_px, 240.0};
  shifted.shape = radius * radius * Eigen::Matrix2d::Identity();
  for (const ObjectResidual residual : AllResiduals()) {
    const double size = SizeOf(residual, error_px);
    EXPECT_LT(std::min(std::abs(MeanResidual(residual, larger) / size - 1.0),
                       std::abs(MeanResidual(residual, shifted) / size - 1.0)),
              0.03)
        << NameOf(residual);
  }
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/brown.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>

namespace hullslam {
namespace {

// The radial factor and its derivative by the squared radius.
struct Radial {
  double factor;
  double slope;
};

Radial RadialAt(const PinholeCamera& camera, double r2) {
  const double above = 1.0 + r2 * (camera.k1 + r2 * (camera.k2 + r2 * camera.k3));
  const double below = 1.0 + r2 * (camera.k4 + r2 * (camera.k5 + r2 * camera.k6));
  const double above_slope = camera.k1 + r2 * (2.0 * camera.k2 + 3.0 * r2 * camera.k3);
  const double below_slope = camera.k4 + r2 * (2.0 * camera.k5 + 3.0 * r2 * camera.k6);
  return {above / below, (above_slope * below - above * below_slope) / (below * below)};
}

}  // namespace

std::array<double, 8> BrownCoefficients(const PinholeCamera& camera) {
  if (camera.lens != LensModel::kBrown) {
    return {};
  }
  return {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3, camera.k4, camera.k5, camera.k6};
}

LensPoint DistortBrown(const PinholeCamera& camera, const Eigen::Vector2d& point) {
  const double x = point.x();
  const double y = point.y();
  const double r2 = x * x + y * y;
  const auto [radial, slope] = RadialAt(camera, r2);
  const double p1 = camera.p1;
  const double p2 = camera.p2;
  LensPoint result;
  result.point = {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
                  y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
  result.jacobian(0, 0) = radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x;
  result.jacobian(0, 1) = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
  result.jacobian(1, 0) = result.jacobian(0, 1);
  result.jacobian(1, 1) = radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  return result;
}

Eigen::Vector2d UndistortBrown(const PinholeCamera& camera, const Eigen::Vector2d& target) {
  Eigen::Vector2d estimate = target;
  constexpr int kMaxIterations = 20;
  for (int i = 0; i < kMaxIterations; ++i) {
    const LensPoint distorted = DistortBrown(camera, estimate);
    const Eigen::Vector2d error = distorted.point - target;
    if (error.squaredNorm() < 1e-20) {
      break;
    }
    if (distorted.jacobian.determinant() <= 1e-6) {
      break;  // the polynomial folds here and has no inverse beyond
    }
    estimate -= distorted.jacobian.inverse() * error;
  }
  return estimate;
}

double FoldOfBrown(const PinholeCamera& camera) {
  constexpr double kLargestAngle = 89.0 * std::numbers::pi / 180.0;
  constexpr int kSteps = 890;  // of a tenth of a degree
  double before = 0.0;
  for (int i = 1; i <= kSteps; ++i) {
    const double r = std::tan(kLargestAngle * i / kSteps);
    const auto [factor, slope] = RadialAt(camera, r * r);
    // The comparisons are written so that a NaN is a fold.
    if (!(factor + 2.0 * r * r * slope > 0.0) || !(r * factor >= before)) {
      return before;
    }
    before = r * factor;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace hullslam

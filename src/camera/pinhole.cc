// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/camera/pinhole.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace hullslam {
namespace {

struct Distortion {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;
};

// Brown's model on normalised coordinates, with its derivative.
Distortion DistortNormalized(const PinholeCamera& camera, const Eigen::Vector2d& p) {
  const double x = p.x();
  const double y = p.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (camera.k1 + r2 * (camera.k2 + r2 * camera.k3));
  const double slope =
      camera.k1 + r2 * (2.0 * camera.k2 + 3.0 * r2 * camera.k3);  // d radial / d r2
  const double p1 = camera.p1;
  const double p2 = camera.p2;
  Distortion result;
  result.point = {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
                  y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
  result.jacobian(0, 0) = radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x;
  result.jacobian(0, 1) = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
  result.jacobian(1, 0) = result.jacobian(0, 1);
  result.jacobian(1, 1) = radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  return result;
}

}  // namespace

void PinholeCamera::Bind(OptionTable& options) {
  options.Add("Camera.fx", &fx, Range::Positive(), "focal length in x, px");
  options.Add("Camera.fy", &fy, Range::Positive(), "focal length in y, px");
  options.Add("Camera.cx", &cx, Range::Any(), "principal point in x, px");
  options.Add("Camera.cy", &cy, Range::Any(), "principal point in y, px");
  options.Add("Camera.k1", &k1, Range::Any(), "radial distortion, second order");
  options.Add("Camera.k2", &k2, Range::Any(), "radial distortion, fourth order");
  options.Add("Camera.p1", &p1, Range::Any(), "tangential distortion");
  options.Add("Camera.p2", &p2, Range::Any(), "tangential distortion");
  options.Add("Camera.k3", &k3, Range::Any(), "radial distortion, sixth order");
  options.Add("Camera.width", &width, Range::Between(16, 16384), "width of the images, px");
  options.Add("Camera.height", &height, Range::Between(16, 16384), "height of the images, px");
  options.Add("Camera.bf", &bf, Range::Positive(),
              "baseline of the virtual stereo camera (m) times fx (px)");
}

Eigen::Vector2d PinholeCamera::Distort(const Eigen::Vector2d& undistorted) const {
  const Eigen::Vector2d normalized((undistorted.x() - cx) / fx, (undistorted.y() - cy) / fy);
  const Eigen::Vector2d distorted = DistortNormalized(*this, normalized).point;
  return {fx * distorted.x() + cx, fy * distorted.y() + cy};
}

Eigen::Vector2d PinholeCamera::Undistort(const Eigen::Vector2d& raw) const {
  if (!IsDistorted()) {
    return raw;
  }
  const Eigen::Vector2d target((raw.x() - cx) / fx, (raw.y() - cy) / fy);
  Eigen::Vector2d estimate = target;
  constexpr int kMaxIterations = 20;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Distortion distortion = DistortNormalized(*this, estimate);
    const Eigen::Vector2d error = distortion.point - target;
    if (error.squaredNorm() < 1e-20) {
      break;
    }
    if (distortion.jacobian.determinant() <= 1e-6) {
      break;  // the polynomial folds here and has no inverse beyond
    }
    estimate -= distortion.jacobian.inverse() * error;
  }
  return {fx * estimate.x() + cx, fy * estimate.y() + cy};
}

PinholeCamera::Bounds PinholeCamera::UndistortedBounds() const {
  Bounds bounds{.min_x = std::numeric_limits<double>::max(),
                .min_y = std::numeric_limits<double>::max(),
                .max_x = std::numeric_limits<double>::lowest(),
                .max_y = std::numeric_limits<double>::lowest()};
  const auto include = [&](double x, double y) {
    const Eigen::Vector2d p = Undistort({x, y});
    bounds.min_x = std::min(bounds.min_x, p.x());
    bounds.min_y = std::min(bounds.min_y, p.y());
    bounds.max_x = std::max(bounds.max_x, p.x());
    bounds.max_y = std::max(bounds.max_y, p.y());
  };
  // The whole border is used, not only the corners: with barrel distortion the middle of a side
  // bulges out.
  constexpr int kSteps = 32;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = static_cast<double>(width) * i / kSteps;
    const double y = static_cast<double>(height) * i / kSteps;
    include(x, 0.0);
    include(x, height);
    include(0.0, y);
    include(width, y);
  }
  return bounds;
}

}  // namespace hullslam

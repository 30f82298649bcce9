// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/depth_anchor.h"

#include <Eigen/Geometry>

namespace hullslam {
namespace {

// A point nearer to the centre than this share of the half axes has no direction.
constexpr double kCenter = 1e-3;

// Distance of the point from the surface along the ray to the centre, and its derivative.
double RadialDistance(const QuadricInCamera& quadric, const Eigen::Vector3d& point,
                      ByObjectInCamera& derivative) {
  derivative.setZero();
  const Eigen::Vector3d from_center = point - quadric.center();
  const Eigen::Vector3d scaled =
      (quadric.cam_from_object().transpose() * from_center).cwiseQuotient(quadric.half_axes());
  const double level = scaled.norm();  // 1 on the surface
  if (level < kCenter) {
    return -quadric.half_axes().minCoeff();
  }
  const double length = from_center.norm();
  // The gradient of level: d level = gradient . d from_center.
  const Eigen::Vector3d gradient =
      quadric.cam_from_object() * scaled.cwiseQuotient(quadric.half_axes()) / level;
  const double by_length = 1.0 - 1.0 / level;
  const double by_level = length / (level * level);
  derivative << by_level * gradient.cross(from_center).transpose(),
      -by_length / length * from_center.transpose() - by_level * gradient.transpose(),
      -by_level / level * scaled.cwiseAbs2().transpose();
  return length * by_length;
}

}  // namespace

DepthAnchorCost::DepthAnchorCost(std::span<const Eigen::Vector3d> points, double sigma)
    : ObjectCost(points.size()),
      points_(points.begin(), points.end()),
      inverse_sigma_(1.0 / sigma) {}

bool DepthAnchorCost::Evaluate(double const* const* parameters, double* residuals,
                               double** jacobians) const {
  const QuadricInCamera quadric(parameters);
  ByObjectInCamera derivative;
  for (size_t i = 0; i < points_.size(); ++i) {
    residuals[i] = inverse_sigma_ * RadialDistance(quadric, points_[i], derivative);
    if (jacobians != nullptr) {
      quadric.WriteRow(static_cast<int>(i), inverse_sigma_ * derivative, jacobians);
    }
  }
  return true;
}

}  // namespace hullslam

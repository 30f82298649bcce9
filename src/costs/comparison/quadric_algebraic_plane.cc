// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_algebraic_plane.h"

#include <Eigen/Geometry>

namespace hullslam {
namespace {

Eigen::Vector3d PlaneNormal(const PinholeCamera& camera, const Line2& line) {
  const Eigen::Vector2d& n = line.normal;
  return Eigen::Vector3d(camera.fx * n.x(), camera.fy * n.y(),
                         camera.cx * n.x() + camera.cy * n.y() + line.offset)
      .normalized();
}

}  // namespace

LinePlane::LinePlane(const PinholeCamera& camera, const SilhouetteLine& line)
    : normal_(PlaneNormal(camera, line.line)), is_one_sided_(line.is_one_sided) {}

double LinePlane::Value(const QuadricInCamera& quadric) const {
  const double distance = normal_.dot(quadric.center());
  const double value = normal_.dot(quadric.square() * normal_) - distance * distance;
  return IsMet(value, distance) ? 0.0 : value;
}

ByObjectInCamera LinePlane::Derivative(const QuadricInCamera& quadric) const {
  const Eigen::Vector3d square_n = quadric.square() * normal_;
  const double distance = normal_.dot(quadric.center());
  ByObjectInCamera derivative = ByObjectInCamera::Zero();
  if (!IsMet(normal_.dot(square_n) - distance * distance, distance)) {
    const Eigen::Array3d along_axes = (quadric.axes().transpose() * normal_).array();
    derivative << 2.0 * square_n.cross(normal_).transpose(), -2.0 * distance * normal_.transpose(),
        2.0 * along_axes.square().matrix().transpose();
  }
  return derivative;
}

bool LinePlane::IsMet(double value, double distance) const {
  return is_one_sided_ && (value > 0.0 || distance > 0.0);
}

std::vector<LinePlane> PlanesOf(const PinholeCamera& camera,
                                std::span<const SilhouetteLine> lines) {
  std::vector<LinePlane> planes;
  planes.reserve(lines.size());
  for (const SilhouetteLine& line : lines) {
    planes.emplace_back(camera, line);
  }
  return planes;
}

AlgebraicPlaneCost::AlgebraicPlaneCost(const PinholeCamera& camera,
                                       std::span<const SilhouetteLine> lines, double sigma)
    : ObjectCost(lines.size()), planes_(PlanesOf(camera, lines)), inverse_sigma_(1.0 / sigma) {}

bool AlgebraicPlaneCost::Evaluate(double const* const* parameters, double* residuals,
                                  double** jacobians) const {
  const QuadricInCamera quadric(parameters);
  if (!quadric.IsInFront()) {
    return false;
  }
  for (size_t i = 0; i < planes_.size(); ++i) {
    residuals[i] = inverse_sigma_ * planes_[i].Value(quadric);
    if (jacobians != nullptr) {
      quadric.WriteRow(static_cast<int>(i), inverse_sigma_ * planes_[i].Derivative(quadric),
                       jacobians);
    }
  }
  return true;
}

const ResidualKind kAlgebraicPlaneResidual = {
    .name = "algebraic_plane",
    .primitives = kAllPrimitives,
    .takes_lines = true,
    .of_pixel_error =
        [](double error_px, const ProjectedSize& size) {
          const double metres_per_px = size.depth / size.focal_px;
          return 2.0 * size.radius_px * error_px * metres_per_px * metres_per_px;
        },
    .make_cost = MakeLineCost<AlgebraicPlaneCost>};

}  // namespace hullslam

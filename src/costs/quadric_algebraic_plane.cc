// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/quadric_algebraic_plane.h"

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

AlgebraicPlaneCost::AlgebraicPlaneCost(const PinholeCamera& camera,
                                       std::span<const SilhouetteLine> lines, double sigma)
    : ObjectCost(lines.size()), inverse_sigma_(1.0 / sigma) {
  planes_.reserve(lines.size());
  for (const SilhouetteLine& line : lines) {
    planes_.push_back({PlaneNormal(camera, line.line), line.is_one_sided});
  }
}

bool AlgebraicPlaneCost::Evaluate(double const* const* parameters, double* residuals,
                                  double** jacobians) const {
  const QuadricInCamera quadric(parameters);
  if (!quadric.IsInFront()) {
    return false;
  }
  for (size_t i = 0; i < planes_.size(); ++i) {
    const Eigen::Vector3d& n = planes_[i].normal;
    const Eigen::Vector3d square_n = quadric.square() * n;
    const double distance = n.dot(quadric.center());
    const double value = n.dot(square_n) - distance * distance;
    const bool is_met = planes_[i].is_one_sided && (value > 0.0 || distance > 0.0);
    residuals[i] = is_met ? 0.0 : inverse_sigma_ * value;
    if (jacobians == nullptr) {
      continue;
    }
    ByObjectInCamera derivative = ByObjectInCamera::Zero();
    if (!is_met) {
      const Eigen::Array3d along_axes = (quadric.axes().transpose() * n).array();
      derivative << 2.0 * square_n.cross(n).transpose(), -2.0 * distance * n.transpose(),
          2.0 * along_axes.square().matrix().transpose();
    }
    quadric.WriteRow(static_cast<int>(i), inverse_sigma_ * derivative, jacobians);
  }
  return true;
}

const ResidualKind kAlgebraicPlaneResidual = {
    .name = "algebraic_plane",
    .primitives = kAllPrimitives,
    .takes_lines = true,
    .of_pixel_error =
        [](double error_px, const ProjectedSize& size) {
          return 2.0 * size.radius_px * error_px * size.metres_per_px * size.metres_per_px;
        },
    .make_cost = [](const ObjectCostInput& input) -> std::unique_ptr<ceres::CostFunction> {
      return input.lines.empty()
                 ? nullptr
                 : std::make_unique<AlgebraicPlaneCost>(input.camera, input.lines, input.sigma);
    }};

}  // namespace hullslam

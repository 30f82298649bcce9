// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_algebraic_point.h"

#include <Eigen/LU>

#include "util/chi_square.h"
#include "util/thin.h"

namespace hullslam {

AlgebraicPointCost::AlgebraicPointCost(const PinholeCamera& camera,
                                       std::span<const Eigen::Vector2d> contour, double sigma)
    : ObjectCost(contour.size()),
      camera_(camera),
      contour_(contour.begin(), contour.end()),
      inverse_sigma_(1.0 / sigma) {}

bool AlgebraicPointCost::Evaluate(double const* const* parameters, double* residuals,
                                  double** jacobians) const {
  const QuadricInCamera quadric(parameters);
  if (!quadric.IsInFront()) {
    return false;
  }
  EllipseProjection ellipse(camera_, quadric);
  if (!ellipse.HasArea()) {
    return false;
  }
  if (jacobians != nullptr) {
    ellipse.Linearize();
  }
  const Eigen::Matrix2d inverse_shape = ellipse.shape().inverse();
  for (size_t i = 0; i < contour_.size(); ++i) {
    const Eigen::Vector2d from_center = contour_[i] - ellipse.center();
    const Eigen::Vector2d y = inverse_shape * from_center;
    residuals[i] = inverse_sigma_ * (from_center.dot(y) - 1.0);
    if (jacobians != nullptr) {
      ByEllipse by_ellipse;
      by_ellipse << -2.0 * y.transpose(), -y.x() * y.x(), -2.0 * y.x() * y.y(), -y.y() * y.y();
      ellipse.WriteRow(static_cast<int>(i), inverse_sigma_ * by_ellipse, jacobians);
    }
  }
  return true;
}

std::vector<Eigen::Vector2d> GateContour(std::span<const Eigen::Vector2d> contour,
                                         const Ellipse& ellipse, double sigma_px) {
  std::vector<Eigen::Vector2d> gated;
  const Eigen::Matrix2d inverse_shape = ellipse.shape.inverse();
  for (const Eigen::Vector2d& point : contour) {
    const Eigen::Vector2d from_center = point - ellipse.center;
    const Eigen::Vector2d y = inverse_shape * from_center;
    const double error = from_center.dot(y) - 1.0;
    const double variance = 4.0 * y.squaredNorm() * sigma_px * sigma_px;
    if (error * error <= Chi2Bound(1) * variance) {
      gated.push_back(point);
    }
  }
  return gated;
}

namespace {

constexpr size_t kMaxPoints = 64;  // neighbours on a contour have the same error
constexpr std::array kPointPrimitives = {ObjectPrimitive::kContour};

std::unique_ptr<ceres::CostFunction> MakePointCost(const ObjectCostInput& input) {
  if (input.detection.contour.size() < 3) {
    return nullptr;
  }
  return std::make_unique<AlgebraicPointCost>(
      input.camera, Thin(input.detection.contour.Unpack(), kMaxPoints), input.sigma);
}

}  // namespace

const ResidualKind kAlgebraicPointResidual = {
    .name = "algebraic_point",
    .primitives = kPointPrimitives,
    .takes_lines = false,
    .of_pixel_error = [](double error_px,
                         const ProjectedSize& size) { return 2.0 * error_px / size.radius_px; },
    .make_cost = MakePointCost};

}  // namespace hullslam

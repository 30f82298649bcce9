// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_algebraic_point.h"

#include <Eigen/LU>

#include "util/lists.h"
#include "util/statistics.h"

namespace hullslam {

AlgebraicPointCost::AlgebraicPointCost(const PinholeCamera& camera,
                                       std::span<const Eigen::Vector2d> contour, double sigma)
    : EllipseCost(contour.size(), camera, sigma), contour_(contour.begin(), contour.end()) {}

void AlgebraicPointCost::Compute(const EllipseNumbers& ellipse, std::span<double> residuals,
                                 std::span<ByEllipse> by_ellipse) const {
  const Eigen::Matrix2d inverse_shape = ToEllipse(ellipse).shape.inverse();
  for (size_t i = 0; i < contour_.size(); ++i) {
    const Eigen::Vector2d from_center = contour_[i] - ellipse.head<2>();
    const Eigen::Vector2d y = inverse_shape * from_center;
    residuals[i] = from_center.dot(y) - 1.0;
    if (!by_ellipse.empty()) {
      by_ellipse[i] << -2.0 * y.transpose(), -y.x() * y.x(), -2.0 * y.x() * y.y(), -y.y() * y.y();
    }
  }
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

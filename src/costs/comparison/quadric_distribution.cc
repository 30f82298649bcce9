// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_distribution.h"

#include <Eigen/LU>
#include <cmath>

namespace hullslam {
namespace {

// Turns a derivative with respect to the centre and the symmetric shape into one with respect to
// the five numbers of an ellipse.
ByEllipse Gather(const Eigen::Vector2d& by_center, const Eigen::Matrix2d& by_shape) {
  ByEllipse by_ellipse;
  by_ellipse << by_center.transpose(), by_shape(0, 0), 2.0 * by_shape(0, 1), by_shape(1, 1);
  return by_ellipse;
}

// In two dimensions tr(X^1/2) = sqrt(tr X + 2 sqrt(det X)).
double Wasserstein(const Ellipse& a, const Ellipse& b, ByEllipse& by_a) {
  const Eigen::Vector2d offset = a.center - b.center;
  const double root_a = std::sqrt(a.shape.determinant());
  const double root_b = std::sqrt(b.shape.determinant());
  const double root_trace = std::sqrt(a.shape.cwiseProduct(b.shape).sum() + 2.0 * root_a * root_b);
  const Eigen::Matrix2d by_shape =
      Eigen::Matrix2d::Identity() - (b.shape + root_a * root_b * a.shape.inverse()) / root_trace;
  by_a = Gather(2.0 * offset, by_shape);
  return offset.squaredNorm() + a.shape.trace() + b.shape.trace() - 2.0 * root_trace;
}

double Bhattacharyya(const Ellipse& a, const Ellipse& b, ByEllipse& by_a) {
  const Eigen::Vector2d offset = a.center - b.center;
  const Eigen::Matrix2d mean = 0.5 * (a.shape + b.shape);
  const Eigen::Matrix2d inverse = mean.inverse();
  const Eigen::Vector2d pull = inverse * offset;
  const Eigen::Matrix2d by_shape =
      0.25 * (inverse - a.shape.inverse()) - pull * pull.transpose() / 16.0;
  by_a = Gather(0.25 * pull, by_shape);
  return 0.125 * offset.dot(pull) +
         0.5 * std::log(mean.determinant() /
                        std::sqrt(a.shape.determinant() * b.shape.determinant()));
}

}  // namespace

double SquaredWasserstein(const Ellipse& a, const Ellipse& b) {
  ByEllipse unused;
  return Wasserstein(a, b, unused);
}

DistributionCost::DistributionCost(const PinholeCamera& camera, const Ellipse& measured,
                                   double sigma, DistributionDistance distance)
    : EllipseCost(1, camera, sigma), measured_(measured), distance_(distance) {}

void DistributionCost::Compute(const EllipseNumbers& ellipse, std::span<double> residuals,
                               std::span<ByEllipse> by_ellipse) const {
  const auto distance =
      distance_ == DistributionDistance::kWasserstein ? Wasserstein : Bhattacharyya;
  ByEllipse derivative;
  residuals[0] = distance(ToEllipse(ellipse), measured_, derivative);
  if (!by_ellipse.empty()) {
    by_ellipse[0] = derivative;
  }
}

namespace {

constexpr std::array kDistributionPrimitives = {ObjectPrimitive::kConic,
                                                ObjectPrimitive::kBoxEllipse};

std::unique_ptr<ceres::CostFunction> MakeDistributionCost(const ObjectCostInput& input) {
  if (!input.detection.ellipse) {
    return nullptr;
  }
  return std::make_unique<DistributionCost>(input.camera, *input.detection.ellipse, input.sigma);
}

}  // namespace

const ResidualKind kDistributionResidual = {
    .name = "distribution",
    .primitives = kDistributionPrimitives,
    .takes_lines = false,
    .of_pixel_error = [](double error_px,
                         const ProjectedSize& /*size*/) { return error_px * error_px; },
    .make_cost = MakeDistributionCost};

}  // namespace hullslam

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
    : ObjectCost(1),
      camera_(camera),
      measured_(measured),
      inverse_sigma_(1.0 / sigma),
      distance_(distance) {}

bool DistributionCost::Evaluate(double const* const* parameters, double* residuals,
                                double** jacobians) const {
  const QuadricInCamera quadric(parameters);
  if (!quadric.IsInFront()) {
    return false;
  }
  EllipseProjection projection(camera_, quadric);
  if (!projection.HasArea()) {
    return false;
  }
  const Ellipse ellipse = ToEllipse(projection.numbers());
  ByEllipse by_ellipse;
  const double distance = distance_ == DistributionDistance::kWasserstein
                              ? Wasserstein(ellipse, measured_, by_ellipse)
                              : Bhattacharyya(ellipse, measured_, by_ellipse);
  residuals[0] = inverse_sigma_ * distance;
  if (jacobians != nullptr) {
    projection.Linearize();
    projection.WriteRow(0, inverse_sigma_ * by_ellipse, jacobians);
  }
  return true;
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

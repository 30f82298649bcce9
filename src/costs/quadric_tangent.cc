// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/quadric_tangent.h"

#include <algorithm>
#include <cmath>

namespace hullslam {
namespace {

// sqrt(n^T S n), px. If the ellipse is a line perpendicular to n, it is zero and has no derivative.
double HalfExtent(const Eigen::Vector2d& n, const EllipseNumbers& ellipse) {
  const double square =
      n.x() * n.x() * ellipse[2] + 2.0 * n.x() * n.y() * ellipse[3] + n.y() * n.y() * ellipse[4];
  return std::sqrt(std::max(square, 1e-12));
}

double Distance(const SilhouetteLine& line, const EllipseNumbers& ellipse, double half_extent) {
  const double distance = line.line.SignedDistance(ellipse.head<2>()) + half_extent;
  return line.is_one_sided ? std::min(distance, 0.0) : distance;
}

}  // namespace

double TangentDistance(const SilhouetteLine& line, const EllipseNumbers& ellipse) {
  return Distance(line, ellipse, HalfExtent(line.line.normal, ellipse));
}

TangentCost::TangentCost(const PinholeCamera& camera, std::span<const SilhouetteLine> lines,
                         double sigma)
    : ObjectCost(lines.size()),
      camera_(camera),
      lines_(lines.begin(), lines.end()),
      inverse_sigma_(1.0 / sigma) {}

bool TangentCost::Evaluate(double const* const* parameters, double* residuals,
                           double** jacobians) const {
  const QuadricInCamera quadric(parameters);
  if (!quadric.IsInFront()) {
    return false;
  }
  EllipseProjection ellipse(camera_, quadric);
  if (jacobians != nullptr) {
    ellipse.Linearize();
  }
  for (size_t i = 0; i < lines_.size(); ++i) {
    const Eigen::Vector2d& n = lines_[i].line.normal;
    const double half_extent = HalfExtent(n, ellipse.numbers());
    const double distance = Distance(lines_[i], ellipse.numbers(), half_extent);
    residuals[i] = inverse_sigma_ * distance;
    if (jacobians == nullptr) {
      continue;
    }
    ByEllipse by_ellipse = ByEllipse::Zero();
    if (!lines_[i].is_one_sided || distance < 0.0) {
      by_ellipse << n.x(), n.y(), 0.5 * n.x() * n.x() / half_extent, n.x() * n.y() / half_extent,
          0.5 * n.y() * n.y() / half_extent;
    }
    ellipse.WriteRow(static_cast<int>(i), inverse_sigma_ * by_ellipse, jacobians);
  }
  return true;
}

const ResidualKind kTangentResidual = {
    .name = "tangent",
    .primitives = kAllPrimitives,
    .takes_lines = true,
    .of_pixel_error = [](double error_px, const ProjectedSize& /*size*/) { return error_px; },
    .make_cost = MakeLineCost<TangentCost>};

}  // namespace hullslam

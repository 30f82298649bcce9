// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_relative_plane.h"

namespace hullslam {

RelativePlaneCost::RelativePlaneCost(const PinholeCamera& camera,
                                     std::span<const SilhouetteLine> lines, double sigma)
    : ObjectCost(lines.size()), planes_(PlanesOf(camera, lines)), inverse_sigma_(1.0 / sigma) {}

bool RelativePlaneCost::Evaluate(double const* const* parameters, double* residuals,
                                 double** jacobians) const {
  const QuadricInCamera quadric(parameters);
  if (!quadric.IsInFront()) {
    return false;
  }
  constexpr int kDepth = 5;  // the shift along the optical axis in ByObjectInCamera
  const double depth = quadric.center().z();
  const double factor = inverse_sigma_ / (depth * depth);
  for (size_t i = 0; i < planes_.size(); ++i) {
    residuals[i] = factor * planes_[i].Value(quadric);
    if (jacobians != nullptr) {
      ByObjectInCamera derivative = factor * planes_[i].Derivative(quadric);
      derivative[kDepth] -= 2.0 * residuals[i] / depth;
      quadric.WriteRow(static_cast<int>(i), derivative, jacobians);
    }
  }
  return true;
}

const ResidualKind kRelativePlaneResidual = {.name = "relative_plane",
                                             .primitives = kAllPrimitives,
                                             .takes_lines = true,
                                             .of_pixel_error =
                                                 [](double error_px, const ProjectedSize& size) {
                                                   return 2.0 * size.radius_px * error_px /
                                                          (size.focal_px * size.focal_px);
                                                 },
                                             .make_cost = MakeLineCost<RelativePlaneCost>};

}  // namespace hullslam

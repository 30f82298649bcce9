// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <cmath>

#include "costs/comparison/quadric_algebraic_point.h"
#include "costs/residual_kind.h"
#include "util/lists.h"

namespace hullslam {
namespace {

constexpr size_t kMostFiltered = 64;  // as for algebraic_point
constexpr std::array kContourPrimitives = {ObjectPrimitive::kContour};

// The points of the contour that the projected ellipse does not refuse.
std::vector<Eigen::Vector2d> Filter(const std::vector<Eigen::Vector2d>& contour,
                                    const Ellipse& projected, double sigma) {
  const double radius_px = std::pow(projected.shape.determinant(), 0.25);
  std::vector<Eigen::Vector2d> kept =
      GateContour(contour, projected, 0.5 * sigma * radius_px);  // of_pixel_error, inverted
  return 2 * kept.size() >= contour.size() ? kept : contour;
}

std::unique_ptr<ceres::CostFunction> MakeFilteredCost(const ObjectCostInput& input) {
  std::vector<Eigen::Vector2d> contour = input.detection.contour.Unpack();
  if (contour.size() < 3) {
    return nullptr;
  }
  if (input.projected) {
    contour = Filter(contour, *input.projected, input.sigma);
  }
  return std::make_unique<AlgebraicPointCost>(input.camera, Thin(contour, kMostFiltered),
                                              input.sigma);
}

}  // namespace

const ResidualKind kFilteredPointResidual = {
    .name = "filtered_point",
    .primitives = kContourPrimitives,
    .takes_lines = false,
    .of_pixel_error = [](double error_px,
                         const ProjectedSize& size) { return 2.0 * error_px / size.radius_px; },
    .make_cost = MakeFilteredCost,
    .needs_projection = true};

}  // namespace hullslam

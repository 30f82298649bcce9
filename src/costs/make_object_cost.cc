// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/make_object_cost.h"

#include <vector>

#include "costs/quadric_algebraic_plane.h"
#include "costs/quadric_algebraic_point.h"
#include "costs/quadric_distribution.h"
#include "costs/quadric_overlap.h"
#include "costs/quadric_tangent.h"

namespace hullslam {
namespace {

constexpr size_t kMaxPoints = 64;  // neighbours on a contour have the same error
constexpr int kConicVertices = 64;

std::vector<Eigen::Vector2d> Thin(std::span<const Eigen::Vector2d> contour) {
  const size_t count = std::min(contour.size(), kMaxPoints);
  std::vector<Eigen::Vector2d> thinned;
  thinned.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    thinned.push_back(contour[i * contour.size() / count]);
  }
  return thinned;
}

using CostPointer = std::unique_ptr<ceres::CostFunction>;

CostPointer OverlapWithRegion(const PinholeCamera& camera, std::span<const Eigen::Vector2d> region,
                              double sigma) {
  if (region.size() < 3) {
    return nullptr;
  }
  return std::make_unique<OverlapCost>(camera, region, sigma);
}

CostPointer MakeOverlap(ObjectPrimitive primitive, const PinholeCamera& camera,
                        const ObjectMeasurement& measurement, double sigma) {
  if (primitive == ObjectPrimitive::kHull) {
    return OverlapWithRegion(camera, measurement.hull, sigma);
  }
  if (primitive == ObjectPrimitive::kContour) {
    return OverlapWithRegion(camera, measurement.contour, sigma);
  }
  if (primitive == ObjectPrimitive::kConic && measurement.ellipse.has_value()) {
    return OverlapWithRegion(camera, measurement.ellipse->Polygon(kConicVertices), sigma);
  }
  if (primitive == ObjectPrimitive::kBox && !measurement.box.isEmpty()) {
    return std::make_unique<OverlapCost>(camera, measurement.box, sigma);
  }
  return nullptr;
}

bool HasInput(ObjectResidual residual, const ObjectMeasurement& measurement) {
  switch (residual) {
    case ObjectResidual::kTangent:
    case ObjectResidual::kAlgebraicPlane:
      return !measurement.lines.empty();
    case ObjectResidual::kAlgebraicPoint:
      return measurement.contour.size() >= 3;
    case ObjectResidual::kDistribution:
      return measurement.ellipse.has_value();
    case ObjectResidual::kOverlap:  // depends on the primitive
      return true;
  }
  return false;
}

}  // namespace

CostPointer MakeObjectCost(ObjectResidual residual, ObjectPrimitive primitive,
                           const PinholeCamera& camera, const ObjectMeasurement& measurement,
                           double sigma) {
  if (!IsSupported(residual, primitive) || !HasInput(residual, measurement)) {
    return nullptr;
  }
  switch (residual) {
    case ObjectResidual::kTangent:
      return std::make_unique<TangentCost>(camera, measurement.lines, sigma);
    case ObjectResidual::kAlgebraicPlane:
      return std::make_unique<AlgebraicPlaneCost>(camera, measurement.lines, sigma);
    case ObjectResidual::kAlgebraicPoint:
      return std::make_unique<AlgebraicPointCost>(camera, Thin(measurement.contour), sigma);
    case ObjectResidual::kDistribution:
      return std::make_unique<DistributionCost>(camera, measurement.ellipse.value(), sigma);
    case ObjectResidual::kOverlap:
      return MakeOverlap(primitive, camera, measurement, sigma);
  }
  return nullptr;
}

}  // namespace hullslam

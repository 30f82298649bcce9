// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/costs/make_object_cost.h"

#include <vector>

#include "hullslam/costs/quadric_algebraic_plane.h"
#include "hullslam/costs/quadric_algebraic_point.h"
#include "hullslam/costs/quadric_distribution.h"
#include "hullslam/costs/quadric_overlap.h"
#include "hullslam/costs/quadric_tangent.h"

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

std::unique_ptr<ceres::CostFunction> OverlapWithRegion(const Intrinsics& camera,
                                                       std::span<const Eigen::Vector2d> region,
                                                       double sigma) {
  return region.size() < 3 ? nullptr : std::make_unique<OverlapCost>(camera, region, sigma);
}

std::unique_ptr<ceres::CostFunction> MakeOverlap(ObjectPrimitive primitive,
                                                 const Intrinsics& camera,
                                                 const ObjectMeasurement& measurement,
                                                 double sigma) {
  switch (primitive) {
    case ObjectPrimitive::kHull:
      return OverlapWithRegion(camera, measurement.hull, sigma);
    case ObjectPrimitive::kContour:
      return OverlapWithRegion(camera, measurement.contour, sigma);
    case ObjectPrimitive::kConic:
      return measurement.ellipse.has_value()
                 ? OverlapWithRegion(camera, measurement.ellipse->Polygon(kConicVertices), sigma)
                 : nullptr;
    case ObjectPrimitive::kBox:
      return measurement.box.isEmpty()
                 ? nullptr
                 : std::make_unique<OverlapCost>(camera, measurement.box, sigma);
    case ObjectPrimitive::kSupport:
      break;
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<ceres::CostFunction> MakeObjectCost(ObjectResidual residual,
                                                    ObjectPrimitive primitive,
                                                    const Intrinsics& camera,
                                                    const ObjectMeasurement& measurement,
                                                    double sigma) {
  if (!IsSupported(residual, primitive)) {
    return nullptr;
  }
  switch (residual) {
    case ObjectResidual::kTangent:
      return measurement.lines.empty()
                 ? nullptr
                 : std::make_unique<TangentCost>(camera, measurement.lines, sigma);
    case ObjectResidual::kAlgebraicPlane:
      return measurement.lines.empty()
                 ? nullptr
                 : std::make_unique<AlgebraicPlaneCost>(camera, measurement.lines, sigma);
    case ObjectResidual::kAlgebraicPoint:
      return measurement.contour.size() < 3
                 ? nullptr
                 : std::make_unique<AlgebraicPointCost>(camera, Thin(measurement.contour), sigma);
    case ObjectResidual::kDistribution:
      return measurement.ellipse.has_value()
                 ? std::make_unique<DistributionCost>(camera, *measurement.ellipse, sigma)
                 : nullptr;
    case ObjectResidual::kOverlap:
      return MakeOverlap(primitive, camera, measurement, sigma);
  }
  return nullptr;
}

}  // namespace hullslam

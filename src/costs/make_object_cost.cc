// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/make_object_cost.h"

#include "costs/quadric_algebraic_plane.h"
#include "costs/quadric_algebraic_point.h"
#include "costs/quadric_distribution.h"
#include "costs/quadric_overlap.h"
#include "costs/quadric_tangent.h"
#include "util/thin.h"

namespace hullslam {
namespace {

constexpr size_t kMaxPoints = 64;  // neighbours on a contour have the same error
constexpr int kConicVertices = 64;

using CostPointer = std::unique_ptr<ceres::CostFunction>;

CostPointer OverlapWithRegion(const PinholeCamera& camera, std::span<const Eigen::Vector2d> region,
                              double sigma) {
  if (region.size() < 3) {
    return nullptr;
  }
  return std::make_unique<OverlapCost>(camera, region, sigma);
}

CostPointer MakeOverlap(const PinholeCamera& camera, const Detection& detection, double sigma) {
  const ObjectPrimitive primitive = detection.primitive;
  if (primitive == ObjectPrimitive::kHull) {
    return OverlapWithRegion(camera, detection.hull, sigma);
  }
  if (primitive == ObjectPrimitive::kContour) {
    return OverlapWithRegion(camera, detection.contour.Unpack(), sigma);
  }
  if (primitive == ObjectPrimitive::kConic && detection.ellipse.has_value()) {
    return OverlapWithRegion(camera, detection.ellipse->Polygon(kConicVertices), sigma);
  }
  if (primitive == ObjectPrimitive::kBox && !detection.box.isEmpty()) {
    return std::make_unique<OverlapCost>(camera, detection.box, sigma);
  }
  return nullptr;
}

bool HasInput(ObjectResidual residual, const Detection& detection,
              std::span<const SilhouetteLine> lines) {
  switch (residual) {
    case ObjectResidual::kTangent:
    case ObjectResidual::kAlgebraicPlane:
      return !lines.empty();
    case ObjectResidual::kAlgebraicPoint:
      return detection.contour.size() >= 3;
    case ObjectResidual::kDistribution:
      return detection.ellipse.has_value();
    case ObjectResidual::kOverlap:  // depends on the primitive
      return true;
  }
  return false;
}

}  // namespace

CostPointer MakeObjectCost(ObjectResidual residual, const PinholeCamera& camera,
                           const Detection& detection, std::span<const SilhouetteLine> lines,
                           double sigma) {
  if (!AcceptsPrimitive(residual, detection.primitive) || !HasInput(residual, detection, lines)) {
    return nullptr;
  }
  switch (residual) {
    case ObjectResidual::kTangent:
      return std::make_unique<TangentCost>(camera, lines, sigma);
    case ObjectResidual::kAlgebraicPlane:
      return std::make_unique<AlgebraicPlaneCost>(camera, lines, sigma);
    case ObjectResidual::kAlgebraicPoint:
      return std::make_unique<AlgebraicPointCost>(
          camera, Thin(detection.contour.Unpack(), kMaxPoints), sigma);
    case ObjectResidual::kDistribution:
      return std::make_unique<DistributionCost>(camera, detection.ellipse.value(), sigma);
    case ObjectResidual::kOverlap:
      return MakeOverlap(camera, detection, sigma);
  }
  return nullptr;
}

}  // namespace hullslam

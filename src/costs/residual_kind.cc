// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/residual_kind.h"

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "costs/ellipse_projection.h"
#include "costs/manifolds.h"

namespace hullslam {

std::unique_ptr<ceres::CostFunction> MakeObjectCost(
    ObjectResidual residual, const PinholeCamera& camera, const Detection& detection,
    std::span<const SilhouetteLine> lines, double sigma, std::optional<Ellipse> projected) {
  if (!AcceptsPrimitive(residual, detection.primitive)) {
    return nullptr;
  }
  return KindOf(residual).make_cost({.camera = camera,
                                     .detection = detection,
                                     .lines = lines,
                                     .sigma = sigma,
                                     .projected = std::move(projected)});
}

std::optional<double> ResidualOfPixelError(ObjectResidual residual, const PinholeCamera& camera,
                                           const Rigid3& cam_from_world, const Ellipsoid& ellipsoid,
                                           double error_px) {
  const PoseBlock camera_block = ToBlock(cam_from_world);
  const PoseBlock object_block = ToBlock(ellipsoid.world_from_object);
  const Eigen::Vector3d log_axes = ellipsoid.half_axes.array().log();
  const std::array<const double*, 3> parameters = {camera_block.data(), object_block.data(),
                                                   log_axes.data()};
  const QuadricInCamera quadric(parameters.data());
  if (!quadric.IsInFront()) {
    return std::nullopt;
  }
  const EllipseProjection ellipse(camera, quadric);
  if (!ellipse.HasArea()) {
    return std::nullopt;
  }
  const double radius = std::pow(ellipse.shape().determinant(), 0.25);
  return KindOf(residual).of_pixel_error(error_px,
                                         {.radius_px = radius,
                                          .depth = quadric.center().z(),
                                          .focal_px = std::sqrt(std::abs(camera.fx * camera.fy))});
}

}  // namespace hullslam

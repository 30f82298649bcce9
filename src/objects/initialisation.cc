// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/initialisation.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/oriented_box.h"
#include "geometry/polygon.h"
#include "objects/constraint/point_statistics.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

// Rays are nearly parallel if the least eigenvalue of the information matrix of the point where
// they meet, divided by the number of rays, is below this.
constexpr double kMinRayInformation = 1e-3;

// The distance of the centre of a sphere behind the surface that a camera sees, in radii, averaged
// over the silhouette.
constexpr double kSurfaceToCenter = 2.0 / 3.0;

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

// The interval of the points along a direction, without the share that is trimmed at each end.
Interval InnerInterval(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& direction,
                       double trimmed) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    values.push_back(direction.dot(point));
  }
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return {values[static_cast<size_t>(trimmed * last)],
          values[static_cast<size_t>((1.0 - trimmed) * last)]};
}

Eigen::Matrix3d PrincipalAxes(std::span<const Eigen::Vector3d> points) {
  const Eigen::Vector3d mean = MeanOf(points);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    covariance += (point - mean) * (point - mean).transpose();
  }
  Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
  if (axes.determinant() < 0.0) {
    axes.col(2) = -axes.col(2);
  }
  return axes;
}

// The points that remain after trimming along each axis in turn.
std::vector<Eigen::Vector3d> InnerPoints(std::span<const Eigen::Vector3d> points,
                                         const Eigen::Matrix3d& axes, double trimmed) {
  std::vector<Eigen::Vector3d> inner(points.begin(), points.end());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = axes.col(axis);
    const Interval interval = InnerInterval(points, direction, trimmed);
    std::erase_if(inner, [&](const Eigen::Vector3d& point) {
      const double value = direction.dot(point);
      return value < interval.low || value > interval.high;
    });
  }
  return inner;
}

// The radius, in radians, of a circle with the solid angle of the hull: in the undistorted image of
// a fisheye lens, a box is much larger at the rim. An area of the plane z = 1 is the solid angle
// over the cube of the cosine of the angle from the axis.
double AngularRadius(const PinholeCamera& camera, const Detection& detection) {
  const Eigen::Vector3d ray = camera.Unproject(detection.box.center(), 1.0).normalized();
  const double area = SignedArea(detection.hull) / (camera.fx * camera.fy);
  return std::sqrt(std::max(0.0, area) * std::pow(ray.z(), 3) / std::numbers::pi);
}

// A sphere with this centre and the mean size of the boxes. Null if the centre is not in front of
// all cameras.
std::optional<Ellipsoid> SphereAt(const Eigen::Vector3d& center, const PinholeCamera& camera,
                                  std::span<const ResolvedObservation> observations,
                                  const StartOptions& options) {
  double radius = 0.0;
  for (const ResolvedObservation& observation : observations) {
    const double depth = (observation.cam_from_world * center).z();
    if (depth <= 0.0) {
      return std::nullopt;
    }
    radius += AngularRadius(camera, *observation.detection) *
              (observation.cam_from_world * center).norm();
  }
  Ellipsoid sphere;
  sphere.world_from_object.translation = center;
  const double least = options.min_half_axis * MeanDistance(observations, center);
  sphere.half_axes.setConstant(std::max(least, radius / static_cast<double>(observations.size())));
  return sphere;
}

}  // namespace

Ellipsoid FitAlong(std::span<const Eigen::Vector3d> points, const Eigen::Matrix3d& axes,
                   double distance, const StartOptions& options) {
  Ellipsoid ellipsoid;
  ellipsoid.world_from_object.rotation = Eigen::Quaterniond(axes).normalized();
  Eigen::Vector3d center;
  for (int axis = 0; axis < 3; ++axis) {
    const Interval interval = InnerInterval(points, axes.col(axis), options.trimmed);
    center[axis] = 0.5 * (interval.low + interval.high);
    ellipsoid.half_axes[axis] = std::max(options.min_half_axis * distance,
                                         options.inflation * 0.5 * (interval.high - interval.low));
  }
  ellipsoid.world_from_object.translation = axes * center;
  return ellipsoid;
}

std::vector<Ellipsoid> StartsFromPoints(std::span<const Eigen::Vector3d> points, double distance,
                                        const StartOptions& options) {
  if (points.size() < kMinDepthPoints) {
    return {};
  }
  const Eigen::Matrix3d axes = PrincipalAxes(points);
  const std::vector<Eigen::Vector3d> inner = InnerPoints(points, axes, options.trimmed);
  if (inner.size() < kMinDepthPoints) {
    return {};
  }
  std::vector<Ellipsoid> starts = {FitAlong(points, PrincipalAxes(inner), distance, options)};
  if (const std::optional<Eigen::Matrix3d> box = OrientedBoxAxes(inner)) {
    starts.push_back(FitAlong(points, *box, distance, options));
  }
  return starts;
}

std::optional<Ellipsoid> StartFromRays(const PinholeCamera& camera,
                                       std::span<const ResolvedObservation> observations,
                                       const StartOptions& options) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (const ResolvedObservation& observation : observations) {
    const Rigid3 world_from_cam = Inverse(observation.cam_from_world);
    const Eigen::Vector3d ray =
        world_from_cam.rotation *
        camera.Unproject(observation.detection->box.center(), 1.0).normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    information += across;
    right_side += across * world_from_cam.translation;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  if (eigen.eigenvalues().x() < kMinRayInformation * static_cast<double>(observations.size())) {
    return std::nullopt;
  }
  return SphereAt(information.ldlt().solve(right_side), camera, observations, options);
}

std::optional<Ellipsoid> StartFromLandmarks(const PinholeCamera& camera,
                                            std::span<const ResolvedObservation> observations,
                                            const StartOptions& options) {
  std::array<std::vector<double>, 3> coordinates;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (const ResolvedObservation& observation : observations) {
    const std::optional<double> depth = LandmarkDepth(observation);
    if (!depth) {
      continue;
    }
    const Eigen::Vector3d in_camera = camera.Unproject(observation.detection->box.center(), *depth);
    const Rigid3 world_from_cam = Inverse(observation.cam_from_world);
    const Eigen::Vector3d point = world_from_cam * in_camera;
    for (size_t axis = 0; axis < 3; ++axis) {
      coordinates[axis].push_back(point[static_cast<Eigen::Index>(axis)]);
    }
    direction += world_from_cam.rotation * in_camera.normalized();
  }
  if (2 * coordinates[0].size() < observations.size() || coordinates[0].empty()) {
    return std::nullopt;
  }
  const Eigen::Vector3d surface(Median(coordinates[0]), Median(coordinates[1]),
                                Median(coordinates[2]));
  const auto in_front = SphereAt(surface, camera, observations, options);
  if (!in_front) {
    return std::nullopt;
  }
  return SphereAt(surface + kSurfaceToCenter * in_front->half_axes.x() * direction.normalized(),
                  camera, observations, options);
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/validity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "frame/detection/visible_part.h"
#include "geometry/polygon.h"
#include "objects/constraint/misfit.h"

namespace hullslam {

std::string ToString(ObjectRejection reason) {
  static constexpr std::array<const char*, kObjectRejectionCount> kNames = {
      "few_views",    "little_parallax",   "no_start",    "not_refined",
      "not_in_front", "axes_out_of_range", "low_overlap", "off_points",
      "stretched",    "large_misfit",      "elongated",   "part",
      "seldom_seen",  "contradicted",      "fused"};
  return kNames.at(static_cast<size_t>(reason));
}

namespace {

constexpr size_t kMaxPoints = 300;  // largest number of depth points that are tested, about

std::optional<Objection> CheckPoints(const Ellipsoid& ellipsoid,
                                     std::span<const Eigen::Vector3d> points, double margin,
                                     const ValidityOptions& options) {
  const Rigid3 object_from_world = Inverse(ellipsoid.world_from_object);
  std::array<std::vector<double>, 3> extents;
  size_t near = 0;
  for (const Eigen::Vector3d& point : points) {
    near += ellipsoid.RadialDistance(point) <= margin ? 1 : 0;
    const Eigen::Vector3d inside = object_from_world * point;
    for (size_t axis = 0; axis < 3; ++axis) {
      extents[axis].push_back(std::abs(inside[static_cast<Eigen::Index>(axis)]));
    }
  }
  const double share = static_cast<double>(near) / static_cast<double>(points.size());
  if (share < options.min_points_near) {
    return Objection{ObjectRejection::kOffPoints,
                     fmt::format("share of points inside or near {:.2f}, expected at least {:.2f}",
                                 share, options.min_points_near)};
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    std::vector<double>& extent = extents[axis];
    const auto quantile = extent.begin() + static_cast<std::ptrdiff_t>(0.9 * extent.size());
    std::nth_element(extent.begin(), quantile, extent.end());
    const double half = ellipsoid.half_axes[static_cast<Eigen::Index>(axis)];
    if (half > options.max_stretch * *quantile + margin) {
      return Objection{
          ObjectRejection::kStretched,
          fmt::format("half axis {:.3g}, but the points extend only to {:.3g}", half, *quantile)};
    }
  }
  return std::nullopt;
}

std::optional<Objection> CheckElongation(const Ellipsoid& ellipsoid,
                                         std::span<const ResolvedObservation> observations,
                                         const ValidityOptions& options) {
  const double elongation = Elongation(ellipsoid, observations);
  if (elongation <= options.max_elongation) {
    return std::nullopt;
  }
  const double needed = options.elongation_parallax * elongation;
  const double parallax = Parallax(observations, ellipsoid.world_from_object.translation);
  if (parallax >= needed) {
    return std::nullopt;
  }
  return Objection{
      ObjectRejection::kElongated,
      fmt::format("elongation {:.1f} along the view needs a parallax of {:.1f} degrees, has {:.1f}",
                  elongation, needed, parallax)};
}

// A box is compared with the box of the projected ellipse: an ellipse that touches all sides of a
// box covers only 79 % of it.
double Overlap(std::span<const Eigen::Vector2d> ellipse, const Detection& detection) {
  return detection.is_box ? IntersectionOverUnion(BoundingBox(ellipse), detection.box)
                          : IntersectionOverUnion(ellipse, detection.hull);
}

}  // namespace

double NearSurface(const Ellipsoid& ellipsoid, double distance, const ValidityOptions& options) {
  return std::max(options.near_surface * distance,
                  options.near_surface_share * ellipsoid.half_axes.mean());
}

double Elongation(const Ellipsoid& ellipsoid, std::span<const ResolvedObservation> observations) {
  const Eigen::Vector3d& center = ellipsoid.world_from_object.translation;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (const ResolvedObservation& observation : observations) {
    direction += (center - Inverse(observation.cam_from_world).translation).normalized();
  }
  direction.normalize();
  const Eigen::Vector3d in_object = ellipsoid.world_from_object.rotation.conjugate() * direction;
  const Eigen::Vector3d& axes = ellipsoid.half_axes;
  const double along = axes.cwiseProduct(in_object).norm();
  // Radius of the circle with the area of the ellipsoid's orthogonal projection.
  const double across = std::sqrt(axes.prod() * in_object.cwiseQuotient(axes).norm());
  return std::max(along / across, 0.25 * across / along);
}

double MeanOverlap(const Ellipsoid& ellipsoid, const Sensor& sensor,
                   std::span<const ResolvedObservation> observations) {
  const Eigen::AlignedBox2d image(Eigen::Vector2d(sensor.bounds.min_x, sensor.bounds.min_y),
                                  Eigen::Vector2d(sensor.bounds.max_x, sensor.bounds.max_y));
  double sum = 0.0;
  for (const ResolvedObservation& observation : observations) {
    const auto ellipse =
        ProjectEllipsoid(sensor.camera.Matrix(), observation.cam_from_world, ellipsoid);
    if (ellipse) {
      sum += Overlap(VisiblePart(ellipse->Polygon(), sensor.camera, image), *observation.detection);
    }
  }
  return sum / static_cast<double>(std::max<size_t>(1, observations.size()));
}

std::optional<Objection> FindObjection(const Ellipsoid& ellipsoid, const Sensor& sensor,
                                       std::span<const ResolvedObservation> observations,
                                       const ValidityOptions& options) {
  for (const ResolvedObservation& observation : observations) {
    if (!ProjectEllipsoid(sensor.camera.Matrix(), observation.cam_from_world, ellipsoid)) {
      return Objection{ObjectRejection::kNotInFront,
                       fmt::format("not in front of keyframe {}", observation.keyframe.value)};
    }
  }
  const double distance = MeanDistance(observations, ellipsoid.world_from_object.translation);
  const double least = options.min_half_axis * distance;
  const double largest = options.max_half_axis * distance;
  if (!(ellipsoid.half_axes.minCoeff() >= least) || !(ellipsoid.half_axes.maxCoeff() <= largest)) {
    return Objection{ObjectRejection::kAxesOutOfRange,
                     fmt::format("half axes {:.3g} to {:.3g}, expected {:.3g} to {:.3g}",
                                 ellipsoid.half_axes.minCoeff(), ellipsoid.half_axes.maxCoeff(),
                                 least, largest)};
  }
  const double overlap = MeanOverlap(ellipsoid, sensor, observations);
  if (!(overlap >= options.min_overlap)) {
    return Objection{ObjectRejection::kLowOverlap,
                     fmt::format("mean IoU of ellipse and hull {:.2f}, expected at least {:.2f}",
                                 overlap, options.min_overlap)};
  }
  const double misfit = RelativeMisfit(sensor.camera, ellipsoid, observations);
  if (!(misfit <= options.max_misfit)) {
    return Objection{
        ObjectRejection::kLargeMisfit,
        fmt::format(
            "its outline is off by {:.2f} of the size of the masks, expected at most {:.2f}",
            misfit, options.max_misfit)};
  }
  if (const auto objection = CheckElongation(ellipsoid, observations, options)) {
    return objection;
  }
  const std::vector<Eigen::Vector3d> points = CollectPoints(observations, kMaxPoints);
  return points.size() >= kMinDepthPoints
             ? CheckPoints(ellipsoid, points, NearSurface(ellipsoid, distance, options), options)
             : std::nullopt;
}

}  // namespace hullslam

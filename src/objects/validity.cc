// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/validity.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/polygon_overlap.h"
#include "geometry/polyline.h"

namespace hullslam {
namespace {

constexpr double kMinHalfAxis = 0.005;     // m
constexpr double kMaxHalfAxis = 3.0;       // m
constexpr double kMaxRelativeAxis = 0.2;   // of the distance from the nearest camera
constexpr double kNearSurface = 0.03;      // m outside of the quadric, or
constexpr double kNearSurfaceShare = 0.2;  // of its mean half axis
constexpr double kMaxStretch = 2.5;        // half axis to half extent of the points along it
constexpr size_t kMaxPoints = 300;
constexpr size_t kMinPoints = 20;  // fewer say nothing

std::optional<Objection> CheckPoints(const Ellipsoid& ellipsoid,
                                     std::span<const Eigen::Vector3d> points,
                                     const ValidityOptions& options) {
  const double margin = std::max(kNearSurface, kNearSurfaceShare * ellipsoid.half_axes.mean());
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
                     fmt::format("{:.2f} of its points are in it or near, expected at least {:.2f}",
                                 share, options.min_points_near)};
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    std::vector<double>& extent = extents[axis];
    const auto place = extent.begin() + static_cast<std::ptrdiff_t>(0.9 * extent.size());
    std::nth_element(extent.begin(), place, extent.end());
    const double half = ellipsoid.half_axes[static_cast<Eigen::Index>(axis)];
    if (half > kMaxStretch * *place + margin) {
      return Objection{
          ObjectRejection::kStretched,
          fmt::format("half axis {:.3f} m where its points reach {:.3f} m", half, *place)};
    }
  }
  return std::nullopt;
}

// Of a box with the outline's box: the outline that touches all sides covers 79 % of it.
double Overlap(std::span<const Eigen::Vector2d> outline, const Detection& detection) {
  return detection.is_box ? IntersectionOverUnion(BoundingBox(outline), detection.box)
                          : IntersectionOverUnion(outline, detection.hull);
}

}  // namespace

double MeanOverlap(const Ellipsoid& ellipsoid, const Sensor& sensor,
                   std::span<const ObjectView> views) {
  const Eigen::AlignedBox2d image(Eigen::Vector2d(sensor.bounds.min_x, sensor.bounds.min_y),
                                  Eigen::Vector2d(sensor.bounds.max_x, sensor.bounds.max_y));
  double sum = 0.0;
  for (const ObjectView& view : views) {
    const auto ellipse = ProjectEllipsoid(sensor.camera.Matrix(), view.cam_from_world, ellipsoid);
    if (ellipse) {
      sum += Overlap(ClipToBox(ellipse->Polygon(), image), *view.detection);
    }
  }
  return sum / static_cast<double>(std::max<size_t>(1, views.size()));
}

std::optional<Objection> FindObjection(const Ellipsoid& ellipsoid, const Sensor& sensor,
                                       std::span<const ObjectView> views,
                                       const ValidityOptions& options) {
  double distance = std::numeric_limits<double>::infinity();
  for (const ObjectView& view : views) {
    if (!ProjectEllipsoid(sensor.camera.Matrix(), view.cam_from_world, ellipsoid)) {
      return Objection{ObjectRejection::kNotInFront,
                       fmt::format("not in front of keyframe {}", view.keyframe.value)};
    }
    distance =
        std::min(distance, (view.cam_from_world * ellipsoid.world_from_object.translation).norm());
  }
  const double largest = std::max(kMaxHalfAxis, kMaxRelativeAxis * distance);
  if (!(ellipsoid.half_axes.minCoeff() >= kMinHalfAxis) ||
      !(ellipsoid.half_axes.maxCoeff() <= largest)) {
    return Objection{ObjectRejection::kAxesOutOfRange,
                     fmt::format("half axes {:.3f} to {:.3f} m, expected {} to {:.1f} m",
                                 ellipsoid.half_axes.minCoeff(), ellipsoid.half_axes.maxCoeff(),
                                 kMinHalfAxis, largest)};
  }
  const double overlap = MeanOverlap(ellipsoid, sensor, views);
  if (!(overlap >= options.min_overlap)) {
    return Objection{ObjectRejection::kLowOverlap,
                     fmt::format("mean IoU {:.2f} of outline and hull, expected at least {:.2f}",
                                 overlap, options.min_overlap)};
  }
  const std::vector<Eigen::Vector3d> points = CollectPoints(views, kMaxPoints);
  return points.size() >= kMinPoints ? CheckPoints(ellipsoid, points, options) : std::nullopt;
}

}  // namespace hullslam

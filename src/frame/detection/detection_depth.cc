// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/detection_depth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hullslam/camera/depth.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr double kInside = 4.0;  // px, from the line towards the object
constexpr std::array<double, 2> kBeyond{4.0,
                                        8.0};  // px; two distances, because masks are not exact
constexpr double kFarthestInMask = 32.0;       // px beyond the line
constexpr double kLargestMargin = 5.0;         // px, for eroding the mask
constexpr double kMarginShare = 0.1;           // share of the mask's smaller side

// Something that is nearer than the object by more than this is another object. A smaller
// difference can be noise or the object's own surface. m.
double Step(double depth, const DetectionOptions& options) {
  return std::max(options.occlusion_step, options.occlusion_step_share * depth);
}

enum class Beyond { kUnknown, kNothingNearer, kNearer };

// A point on a line and the direction away from the object, both undistorted.
struct Border {
  Eigen::Vector2d point;
  Eigen::Vector2d outwards;
};

// Depth at a distance (px) beyond the line, m; 0 if it is unknown. If the image has no depth there
// but another mask contains the point, returns the first known depth of that mask farther out. This
// is the depth of the other object along this border, not at its centre.
double DepthBeyond(const Border& border, double distance, const MaskDepth& view,
                   std::span<const MaskRegion* const> others) {
  const auto raw_at = [&](double beyond) {
    return view.camera.Distort(border.point + beyond * border.outwards);
  };
  const Eigen::Vector2d raw = raw_at(distance);
  const double depth = view.AtRaw(raw);
  if (depth > 0.0) {
    return depth;
  }
  for (const MaskRegion* other : others) {
    for (double beyond = distance; beyond <= kFarthestInMask; beyond += kBeyond[0]) {
      const Eigen::Vector2d further = raw_at(beyond);
      if (!other->Contains(further)) {
        break;
      }
      if (const double further_depth = view.AtRaw(further); further_depth > 0.0) {
        return further_depth;
      }
    }
  }
  return 0.0;
}

// Whether a surface that is nearer than the object begins at the line. The surface that the object
// stands on also comes nearer with the distance from the line, but it meets the object at the line.
// So the depths at the two outer points are extrapolated linearly to the point inside the object.
bool BeginsNearer(double own, double near, double far, double step) {
  if (near <= 0.0 || far <= 0.0) {
    return std::max(near, far) > 0.0 && std::max(near, far) < own - step;
  }
  if (near >= own - step) {  // the mask is too small: the other surface begins between the two
    return far < own - step && far < near - step;
  }
  const double slope = (near - far) / (kBeyond[1] - kBeyond[0]);  // m per px
  return near + std::max(0.0, slope) * (kBeyond[0] + kInside) < own - step;
}

Beyond Look(const Border& border, const MaskDepth& view, double object_depth,
            std::span<const MaskRegion* const> others, const DetectionOptions& options) {
  const double inside = view.AtRaw(view.camera.Distort(border.point - kInside * border.outwards));
  const double own = inside > 0.0 ? inside : object_depth;
  const double near = DepthBeyond(border, kBeyond[0], view, others);
  const double far = DepthBeyond(border, kBeyond[1], view, others);
  if (own <= 0.0 || (near <= 0.0 && far <= 0.0)) {
    return Beyond::kUnknown;
  }
  return BeginsNearer(own, near, far, Step(own, options)) ? Beyond::kNearer
                                                          : Beyond::kNothingNearer;
}

}  // namespace

double MaskDepth::AtRaw(const Eigen::Vector2d& raw) const {
  return SampleDepth(image, raw.cast<float>(), units_per_metre);
}

std::vector<Eigen::Vector3d> DepthPoints(const MaskDepth& view, const MaskRegion& region,
                                         int max_points) {
  std::vector<Eigen::Vector3d> points;
  const cv::Rect& box = region.box();
  const double margin =
      std::clamp(kMarginShare * std::min(box.width, box.height), 1.0, kLargestMargin);
  const int step = std::max(
      1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(region.area()) / max_points))));
  for (int y = box.y + step / 2; y < box.br().y; y += step) {
    for (int x = box.x + step / 2; x < box.br().x; x += step) {
      const Eigen::Vector2d raw(x, y);
      if (!region.ContainsAround(raw, margin)) {
        continue;
      }
      const double depth = view.AtRaw(raw);
      const PinholeCamera& camera = view.camera.camera();
      if (depth > 0.0 && camera.SeesRaw(raw)) {
        points.push_back(camera.Unproject(camera.Undistort(raw), depth));
      }
    }
  }
  return points;
}

double MedianDepth(std::span<const Eigen::Vector3d> points) {
  if (points.empty()) {
    return 0.0;
  }
  std::vector<double> depths;
  depths.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    depths.push_back(point.z());
  }
  return Median(std::move(depths));
}

void RemoveFarFromMedian(const MaskCamera& camera, double side, double max_offset,
                         std::vector<Eigen::Vector3d>& points) {
  if (points.empty()) {
    return;
  }
  std::vector<double> depths;
  for (const Eigen::Vector3d& point : points) {
    depths.push_back(camera.DepthOf(point));
  }
  const double median = Median(std::move(depths));
  const double limit = max_offset * side / camera.focal() * median;
  std::erase_if(
      points, [&](const auto& point) { return std::abs(camera.DepthOf(point) - median) > limit; });
}

bool IsHidden(const LineOnOutline& line, const MaskDepth& view, double object_depth,
              std::span<const MaskRegion* const> others, const DetectionOptions& options) {
  int known = 0;
  int hidden = 0;
  for (const Eigen::Vector2d& point : line.near) {
    const Beyond beyond = Look({point, line.line.normal}, view, object_depth, others, options);
    known += beyond != Beyond::kUnknown ? 1 : 0;
    hidden += beyond == Beyond::kNearer ? 1 : 0;
  }
  return hidden > 0 && 2 * hidden >= known;
}

}  // namespace hullslam

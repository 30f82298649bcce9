// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection_depth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hullslam/camera/depth.h"

namespace hullslam {
namespace {

constexpr double kInside = 4.0;                     // px, from the line towards the object
constexpr std::array<double, 2> kBeyond{4.0, 8.0};  // px; two places, because masks are not exact
constexpr double kLargestMargin = 5.0;              // px, for eroding the mask
constexpr double kMarginShare = 0.1;                // of the mask's smaller side

// Something that is nearer than the object by more than this is another object. A smaller
// difference can be noise or the object's own surface. m.
double Step(double depth, const DetectionOptions& options) {
  return std::max(options.occlusion_step, options.occlusion_step_share * depth);
}

enum class Beyond { kUnknown, kNothingNearer, kNearer };

Beyond Look(const Eigen::Vector2d& place, const Eigen::Vector2d& outwards, const DepthView& view,
            double object_depth, std::span<const Occluder> others,
            const DetectionOptions& options) {
  const double inside = view.AtRaw(view.camera.Distort(place - kInside * outwards));
  const double own = inside > 0.0 ? inside : object_depth;
  if (own <= 0.0) {
    return Beyond::kUnknown;
  }
  const double limit = own - Step(own, options);
  Beyond result = Beyond::kUnknown;
  for (const double distance : kBeyond) {
    const Eigen::Vector2d raw = view.camera.Distort(place + distance * outwards);
    const double depth = view.AtRaw(raw);
    const bool in_nearer_mask =
        std::any_of(others.begin(), others.end(), [&](const Occluder& other) {
          return other.depth > 0.0 && other.depth < limit && other.region->Contains(raw);
        });
    if (in_nearer_mask || (depth > 0.0 && depth < limit)) {
      return Beyond::kNearer;
    }
    if (depth > 0.0) {
      result = Beyond::kNothingNearer;
    }
  }
  return result;
}

}  // namespace

double DepthView::AtRaw(const Eigen::Vector2d& raw) const {
  return SampleDepth(image, raw.cast<float>(), units_per_metre);
}

std::vector<Eigen::Vector3d> DepthPoints(const DepthView& view, const MaskRegion& region,
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
      if (depth > 0.0) {
        points.push_back(view.camera.Unproject(view.camera.Undistort(raw), depth));
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
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

bool IsHidden(const LineOnOutline& line, const DepthView& view, double object_depth,
              std::span<const Occluder> others, const DetectionOptions& options) {
  int known = 0;
  int hidden = 0;
  for (const Eigen::Vector2d& place : line.near) {
    const Beyond beyond = Look(place, line.line.normal, view, object_depth, others, options);
    known += beyond != Beyond::kUnknown ? 1 : 0;
    hidden += beyond == Beyond::kNearer ? 1 : 0;
  }
  return hidden > 0 && 2 * hidden >= known;
}

}  // namespace hullslam

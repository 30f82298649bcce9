// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/detection_outline.h"

#include <algorithm>
#include <cmath>

#include "geometry/polygon.h"
#include "geometry/polyline.h"

namespace hullslam {
namespace {

constexpr double kMinArea = 1.0;       // px^2
constexpr double kLargestStep = 12.0;  // px between points of a contour
constexpr double kMostAddedPoints = 20'000.0;

double Perimeter(const Polygon2& outline) {
  double perimeter = 0.0;
  for (size_t i = 0; i < outline.size(); ++i) {
    perimeter += (outline[(i + 1) % outline.size()] - outline[i]).norm();
  }
  return perimeter;
}

// The undistorted outline, with positive signed area. Points are added on long edges, because an
// edge that is straight in the raw image is curved in the undistorted image. The number of added
// points is bounded, however long the edges are.
Polygon2 UndistortDensely(const Polygon2& outline, const MaskCamera& camera) {
  const double largest_step = std::max(kLargestStep, Perimeter(outline) / kMostAddedPoints);
  Polygon2 contour;
  contour.reserve(2 * outline.size());
  for (size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& from = outline[i];
    const Eigen::Vector2d step = outline[(i + 1) % outline.size()] - from;
    const int pieces = std::max(1, static_cast<int>(std::ceil(step.norm() / largest_step)));
    for (int k = 0; k < pieces; ++k) {
      contour.push_back(camera.Undistort(from + step * (static_cast<double>(k) / pieces)));
    }
  }
  if (SignedArea(contour) < 0.0) {
    std::reverse(contour.begin(), contour.end());
  }
  return contour;
}

}  // namespace

std::vector<Polygon2> LargeParts(std::span<const Polygon2> outlines, double min_share) {
  double largest = kMinArea;
  for (const Polygon2& outline : outlines) {
    largest = std::max(largest, std::abs(SignedArea(outline)));
  }
  std::vector<Polygon2> parts;
  for (const Polygon2& outline : outlines) {
    const double area = std::abs(SignedArea(outline));
    if (area >= kMinArea && area >= min_share * largest) {
      parts.push_back(outline);
    }
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Polygon2& a, const Polygon2& b) {
    return std::abs(SignedArea(a)) > std::abs(SignedArea(b));
  });
  return parts;
}

Outline UndistortOutline(std::span<const Polygon2> parts, const MaskCamera& camera) {
  Outline outline;
  for (const Polygon2& part : parts) {
    Polygon2 contour = UndistortDensely(part, camera);
    outline.boundary.insert(outline.boundary.end(), contour.begin(), contour.end());
    if (outline.contour.empty()) {
      outline.contour = std::move(contour);
    }
  }
  // Rounding moves the points that were added on a straight edge away from the edge; this removes
  // them.
  outline.hull = SimplifyPolygon(ConvexHull(outline.boundary), 1e-6);
  return outline;
}

}  // namespace hullslam

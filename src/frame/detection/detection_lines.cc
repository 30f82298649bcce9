// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/detection_lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>

#include "geometry/polygon.h"

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

constexpr double kPi = std::numbers::pi;
constexpr double kTouch = 1.0;  // px; a point this near to a line touches it
constexpr double kNear = 3.0;   // px, about the error of a mask's border
constexpr size_t kMaxPoints = 9;

Eigen::Vector2d Direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

double Reach(const Polygon2& points, const Eigen::Vector2d& direction) {
  double reach = direction.dot(points[0]);
  for (const Eigen::Vector2d& p : points) {
    reach = std::max(reach, direction.dot(p));
  }
  return reach;
}

// At most kMaxPoints of the points with these indices, evenly chosen.
Polygon2 ChooseEvenly(const Polygon2& points, const std::vector<Eigen::Index>& indices) {
  Polygon2 chosen;
  const size_t used = std::min(kMaxPoints, indices.size());
  chosen.reserve(used);
  for (size_t i = 0; i < used; ++i) {
    const Eigen::Index index = indices[used == 1 ? 0 : i * (indices.size() - 1) / (used - 1)];
    chosen.push_back(points[static_cast<size_t>(index)]);
  }
  return chosen;
}

LineOnOutline LineAlong(const Outline& outline, const Line2& line) {
  // The points are taken as the columns of a matrix, because this runs for each line of each mask.
  const Eigen::Map<const Eigen::Matrix2Xd> points(
      outline.boundary[0].data(), 2, static_cast<Eigen::Index>(outline.boundary.size()));
  const Eigen::RowVectorXd reaches = line.normal.transpose() * points;
  const double most = reaches.maxCoeff();
  std::vector<Eigen::Index> near;
  for (Eigen::Index i = 0; i < reaches.size(); ++i) {
    if (reaches[i] >= most - kNear) {
      near.push_back(i);
    }
  }
  std::vector<Eigen::Index> touching;
  std::copy_if(near.begin(), near.end(), std::back_inserter(touching),
               [&](Eigen::Index i) { return reaches[i] >= most - kTouch; });
  return {.line = line,
          .touching = ChooseEvenly(outline.boundary, touching),
          .near = ChooseEvenly(outline.boundary, near)};
}

LineOnOutline SupportLine(const Outline& outline, const Eigen::Vector2d& direction) {
  return LineAlong(outline, {.normal = direction, .offset = -Reach(outline.hull, direction)});
}

struct Edge {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  double length = 0.0;
  Eigen::Vector2d normal;  // outwards
};

std::vector<Edge> EdgesOf(const Polygon2& polygon, double min_length) {
  std::vector<Edge> edges;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& from = polygon[i];
    const Eigen::Vector2d& to = polygon[(i + 1) % polygon.size()];
    const Eigen::Vector2d along = to - from;
    const double length = along.norm();
    if (length >= min_length && length > 0.0) {
      edges.push_back({from, to, length, Eigen::Vector2d(along.y(), -along.x()) / length});
    }
  }
  return edges;
}

// The simplified polygon, or the polygon itself if simplification leaves no area.
Polygon2 Simplified(const Polygon2& polygon, double epsilon) {
  Polygon2 simplified = SimplifyPolygon(polygon, epsilon);
  return simplified.size() >= 3 ? simplified : polygon;
}

// The directions of the edges are added from the longest to the shortest edge. If two directions
// are nearly equal, the one of the longer edge is kept, because it is more precise.
std::vector<Eigen::Vector2d> SupportDirections(const Polygon2& hull,
                                               const DetectionOptions& options) {
  std::vector<Edge> edges = EdgesOf(Simplified(hull, options.epsilon_px), options.min_line_px);
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& a, const Edge& b) { return a.length > b.length; });
  std::vector<Eigen::Vector2d> directions;
  const auto add_new = [&](const Eigen::Vector2d& direction) {
    const bool is_new = std::none_of(directions.begin(), directions.end(), [&](const auto& known) {
      return known.dot(direction) > std::cos(options.min_line_angle);
    });
    if (is_new) directions.push_back(direction);
  };
  for (const Edge& edge : edges) {
    add_new(edge.normal);
  }
  for (int i = 0; i < options.uniform_directions; ++i) {
    add_new(Direction(2.0 * kPi * i / options.uniform_directions));
  }
  std::sort(directions.begin(), directions.end(), [](const auto& a, const auto& b) {
    return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x());
  });
  return directions;
}

std::vector<LineOnOutline> SupportLines(const Outline& outline,
                                        std::span<const Eigen::Vector2d> directions) {
  std::vector<LineOnOutline> lines;
  for (const Eigen::Vector2d& direction : directions) {
    lines.push_back(SupportLine(outline, direction));
  }
  return lines;
}

std::vector<LineOnOutline> EdgeLines(const Polygon2& polygon, double min_length) {
  std::vector<LineOnOutline> lines;
  for (const Edge& edge : EdgesOf(polygon, min_length)) {
    Polygon2 along;
    constexpr int kSamples = 5;
    for (int i = 0; i < kSamples; ++i) {
      along.emplace_back(edge.from + (i + 0.5) / kSamples * (edge.to - edge.from));
    }
    lines.push_back({.line = {.normal = edge.normal, .offset = -edge.normal.dot(edge.from)},
                     .touching = along,
                     .near = along});
  }
  return lines;
}

std::vector<LineOnOutline> TangentLines(const Outline& outline, const Ellipse& ellipse, int count) {
  std::vector<LineOnOutline> lines;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d n = Direction(2.0 * kPi * i / count);
    const double reach = n.dot(ellipse.center) + ellipse.HalfExtent(n);
    lines.push_back(LineAlong(outline, {.normal = n, .offset = -reach}));
  }
  return lines;
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
  // Rounding moves points that were added on a straight edge off the edge; this removes them.
  outline.hull = SimplifyPolygon(ConvexHull(outline.boundary), 1e-6);
  return outline;
}

std::vector<LineOnOutline> LinesOfOutline(const Outline& outline,
                                          const std::optional<Ellipse>& ellipse,
                                          ObjectPrimitive primitive,
                                          const DetectionOptions& options) {
  switch (primitive) {
    case ObjectPrimitive::kSupport:
      return SupportLines(outline, SupportDirections(outline.hull, options));
    case ObjectPrimitive::kHull:
      return EdgeLines(Simplified(outline.hull, options.epsilon_px), options.min_line_px);
    case ObjectPrimitive::kContour:
      return EdgeLines(Simplified(outline.contour, options.epsilon_px), options.min_line_px);
    case ObjectPrimitive::kBox: {
      const Polygon2 directions{{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}};
      return SupportLines(outline, directions);
    }
    case ObjectPrimitive::kConic:
    case ObjectPrimitive::kBoxEllipse:
      return ellipse ? TangentLines(outline, *ellipse, options.conic_lines)
                     : std::vector<LineOnOutline>();
  }
  return {};
}

std::vector<LineOnOutline> SidesOfBox(const Polygon2& raw_corners, const MaskCamera& camera) {
  std::vector<LineOnOutline> sides;
  const size_t count = raw_corners.size();
  const bool is_positive = SignedArea(raw_corners) > 0.0;
  for (size_t i = 0; i < count; ++i) {
    // An undistorted side is curved. The line through its quarter points has half the error of the
    // line through its ends.
    const Eigen::Vector2d& from = raw_corners[is_positive ? i : count - 1 - i];
    const Eigen::Vector2d& to =
        raw_corners[is_positive ? (i + 1) % count : (2 * count - 2 - i) % count];
    const Eigen::Vector2d a = camera.Undistort(from + 0.25 * (to - from));
    const Eigen::Vector2d b = camera.Undistort(from + 0.75 * (to - from));
    const Eigen::Vector2d along = (b - a).normalized();
    const Eigen::Vector2d normal(along.y(), -along.x());
    sides.push_back(
        {.line = {.normal = normal, .offset = -normal.dot(a)}, .touching = {a, b}, .near = {}});
  }
  return sides;
}

}  // namespace hullslam

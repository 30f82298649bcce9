// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/body_overlap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace hullslam {
namespace {

using Eigen::Vector3d;

using Face = std::vector<Vector3d>;  // the corners of a convex polygon, in either order

// The faces of the box with these half extents around the origin of its frame.
std::vector<Face> BoxFaces(const Rigid3& frame_from_box, const Vector3d& half) {
  constexpr std::array<std::array<double, 2>, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::vector<Face> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Face& face = faces.emplace_back();
      for (const auto& [u, v] : kCorners) {
        Vector3d corner;
        corner[axis] = side;
        corner[(axis + 1) % 3] = u;
        corner[(axis + 2) % 3] = v;
        face.push_back(frame_from_box * half.cwiseProduct(corner));
      }
    }
  }
  return faces;
}

// Puts points of a plane that is perpendicular to `axis` into the order of the corners of a convex
// polygon.
void SortAround(int axis, Face& points) {
  Vector3d center = Vector3d::Zero();
  for (const Vector3d& point : points) {
    center += point / static_cast<double>(points.size());
  }
  const auto angle = [&](const Vector3d& point) {
    const Vector3d offset = point - center;
    return std::atan2(offset[(axis + 2) % 3], offset[(axis + 1) % 3]);
  };
  std::sort(points.begin(), points.end(),
            [&](const Vector3d& a, const Vector3d& b) { return angle(a) < angle(b); });
}

// Cuts off the part of a convex polyhedron where side * x[axis] > most.
void Clip(int axis, double side, double most, std::vector<Face>& faces) {
  const auto beyond = [&](const Vector3d& point) { return side * point[axis] - most; };
  const bool is_cut = std::ranges::any_of(faces, [&](const Face& face) {
    return std::ranges::any_of(face, [&](const Vector3d& point) { return beyond(point) > 0.0; });
  });
  if (!is_cut) {
    return;
  }
  Face cap;  // the new face
  std::vector<Face> kept;
  for (const Face& face : faces) {
    Face inside;
    for (size_t i = 0; i < face.size(); ++i) {
      const Vector3d& from = face[i];
      const Vector3d& to = face[(i + 1) % face.size()];
      const double start = beyond(from);
      const double end = beyond(to);
      if (start <= 0.0) {
        inside.push_back(from);
      }
      if (start == 0.0) {
        cap.push_back(from);
      }
      if ((start < 0.0 && end > 0.0) || (start > 0.0 && end < 0.0)) {
        inside.emplace_back(from + start / (start - end) * (to - from));
        cap.push_back(inside.back());
      }
    }
    if (inside.size() >= 3) {
      kept.push_back(std::move(inside));
    }
  }
  SortAround(axis, cap);
  kept.push_back(std::move(cap));
  faces = std::move(kept);
}

// Volume of a convex polyhedron: the sum of the pyramids from a point inside to its faces.
double VolumeOf(const std::vector<Face>& faces) {
  Vector3d inside = Vector3d::Zero();
  double corners = 0.0;
  for (const Face& face : faces) {
    for (const Vector3d& corner : face) {
      inside += corner;
      ++corners;
    }
  }
  inside /= std::max(corners, 1.0);
  double volume = 0.0;
  for (const Face& face : faces) {
    Vector3d area = Vector3d::Zero();
    for (size_t i = 2; i < face.size(); ++i) {
      area += 0.5 * (face[i - 1] - face[0]).cross(face[i] - face[0]);
    }
    volume += face.empty() ? 0.0 : std::abs(area.dot(face[0] - inside)) / 3.0;
  }
  return volume;
}

// 0 if numbers are too small or too large for a ratio.
double Ratio(double both, double a, double b) {
  const double either = a + b - both;
  return either > 0.0 ? std::clamp(both / either, 0.0, 1.0) : 0.0;
}

// Bodies overlap only if the spheres around their boxes do.
bool AreNear(const Body& a, const Body& b) {
  return (a.world_from_body.translation - b.world_from_body.translation).norm() <
         a.half_axes.norm() + b.half_axes.norm();
}

// The part of a line inside a body, as an interval of the parameter; empty if it ends before it
// begins.
struct Interval {
  double begin = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();

  void Meet(double first, double second) {
    begin = std::max(begin, first);
    end = std::min(end, second);
  }
  void MakeEmpty() { Meet(0.0, -1.0); }
};

// The line is origin + t * direction in the frame of the body, each divided by the half axes, so
// that the body is a cube, a cylinder or a sphere of radius 1.
Interval Inside(BodyKind kind, const Vector3d& origin, const Vector3d& direction) {
  Interval interval;
  const int first_flat = kind == BodyKind::kBox ? 0 : kind == BodyKind::kCylinder ? 2 : 3;
  for (int axis = first_flat; axis < 3; ++axis) {
    const double start = origin[axis];
    const double step = direction[axis];
    if (step != 0.0) {
      interval.Meet(-1.0 / std::abs(step) - start / step, 1.0 / std::abs(step) - start / step);
    } else if (std::abs(start) > 1.0) {
      interval.MakeEmpty();
    }
  }
  if (kind == BodyKind::kBox) {
    return interval;
  }
  // |o + t d|^2 = 1 in the coordinates in which the body is round.
  const auto o = origin.head(first_flat);
  const auto d = direction.head(first_flat);
  const double square = d.squaredNorm();
  const double half_linear = o.dot(d);
  const double constant = o.squaredNorm() - 1.0;
  const double root = half_linear * half_linear - square * constant;
  if (square > 0.0 && root > 0.0) {
    interval.Meet((-half_linear - std::sqrt(root)) / square,
                  (-half_linear + std::sqrt(root)) / square);
  } else if (square > 0.0 || constant > 0.0) {
    interval.MakeEmpty();
  }
  return interval;
}

}  // namespace

const char* ToString(BodyKind kind) {
  switch (kind) {
    case BodyKind::kBox:
      return "box";
    case BodyKind::kCylinder:
      return "cylinder";
    case BodyKind::kEllipsoid:
      break;
  }
  return "ellipsoid";
}

double Body::Volume() const {
  constexpr double kPi = std::numbers::pi;
  const double factor = kind == BodyKind::kBox        ? 8.0
                        : kind == BodyKind::kCylinder ? 2.0 * kPi
                                                      : 4.0 / 3.0 * kPi;
  return factor * half_axes.prod();
}

double BoxOverlap(const Body& a, const Body& b) {
  if (!AreNear(a, b)) {
    return 0.0;
  }
  std::vector<Face> faces = BoxFaces(Inverse(b.world_from_body) * a.world_from_body, a.half_axes);
  for (int axis = 0; axis < 3; ++axis) {
    Clip(axis, -1.0, b.half_axes[axis], faces);
    Clip(axis, 1.0, b.half_axes[axis], faces);
  }
  return Ratio(VolumeOf(faces), 8.0 * a.half_axes.prod(), 8.0 * b.half_axes.prod());
}

double SolidOverlap(const Body& a, const Body& b) {
  constexpr int kLines = 128;
  if (a.kind == BodyKind::kBox && b.kind == BodyKind::kBox) {
    return BoxOverlap(a, b);
  }
  if (!AreNear(a, b)) {
    return 0.0;
  }
  const Body& small = a.Volume() <= b.Volume() ? a : b;
  const Body& large = &small == &a ? b : a;
  const Rigid3 large_from_small = Inverse(large.world_from_body) * small.world_from_body;
  const Vector3d direction =
      (large_from_small.rotation * Vector3d::UnitX()).cwiseQuotient(large.half_axes);
  double lengths = 0.0;  // m
  for (int row = 0; row < kLines; ++row) {
    for (int column = 0; column < kLines; ++column) {
      const Vector3d unit(0.0, (2 * row + 1.0) / kLines - 1.0, (2 * column + 1.0) / kLines - 1.0);
      const Vector3d origin = large_from_small * small.half_axes.cwiseProduct(unit);
      Interval both = Inside(small.kind, unit, Vector3d::UnitX() / small.half_axes.x());
      const Interval other = Inside(large.kind, origin.cwiseQuotient(large.half_axes), direction);
      both.Meet(other.begin, other.end);
      lengths += std::max(0.0, both.end - both.begin);
    }
  }
  const double area = 4.0 * small.half_axes.y() * small.half_axes.z() / (kLines * kLines);
  return Ratio(lengths * area, a.Volume(), b.Volume());
}

}  // namespace hullslam

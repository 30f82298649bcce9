// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMaxError = 4e-5;  // metres
constexpr double kFullTurn = 2.0 * std::numbers::pi;

// (|x|^(2/east) + |y|^(2/east))^(east/north) + |z|^(2/north), which is 1 on the surface and
// homogeneous of degree 2/north.
double SuperquadricSum(const Shape& shape, const Vector3d& q) {
  const double around =
      std::pow(std::abs(q.x()), 2.0 / shape.east) + std::pow(std::abs(q.y()), 2.0 / shape.east);
  return std::pow(around, shape.east / shape.north) + std::pow(std::abs(q.z()), 2.0 / shape.north);
}

Vector3d SuperquadricNormal(const Shape& shape, const Vector3d& q) {
  const double around =
      std::pow(std::abs(q.x()), 2.0 / shape.east) + std::pow(std::abs(q.y()), 2.0 / shape.east);
  const double outer = around > 0.0 ? std::pow(around, shape.east / shape.north - 1.0) : 0.0;
  const auto signed_power = [](double x, double exponent) {
    return std::copysign(std::pow(std::abs(x), exponent), x);
  };
  return {outer * signed_power(q.x(), 2.0 / shape.east - 1.0) / shape.half.x(),
          outer * signed_power(q.y(), 2.0 / shape.east - 1.0) / shape.half.y(),
          signed_power(q.z(), 2.0 / shape.north - 1.0) / shape.half.z()};
}

Vector3d BoxNormal(const Vector3d& q) {
  Eigen::Index axis = 0;
  q.cwiseAbs().maxCoeff(&axis);
  Vector3d normal = Vector3d::Zero();
  normal[axis] = q[axis] < 0.0 ? -1.0 : 1.0;
  return normal;
}

Vector3d CylinderNormal(const Vector3d& q) {
  if (std::abs(q.z()) > q.head<2>().norm()) {
    return {0.0, 0.0, q.z() < 0.0 ? -1.0 : 1.0};
  }
  return {q.x(), q.y(), 0.0};
}

Vector3d TorusNormal(const Shape& shape, const Vector3d& point) {
  const double ring = shape.half.x() - shape.tube;
  const Vector3d flat(point.x(), 0.0, point.z());
  return point - ring * flat.normalized();
}

// The normal of the nearest piece of the profile.
Vector3d RevolvedNormal(const Shape& shape, const Vector3d& point) {
  const Vector2d flat(point.head<2>().norm(), point.z());
  double nearest = std::numeric_limits<double>::infinity();
  Vector2d normal = Vector2d::UnitX();
  for (size_t i = 1; i < shape.profile.size(); ++i) {
    const Vector2d along = shape.profile[i] - shape.profile[i - 1];
    const Vector2d offset = flat - shape.profile[i - 1];
    const double share = std::clamp(offset.dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (offset - share * along).norm();
    if (distance < nearest) {
      nearest = distance;
      normal = Vector2d(along.y(), -along.x());
    }
  }
  const Vector2d outwards = point.head<2>().normalized();  // zero on the axis
  return {normal.x() * outwards.x(), normal.x() * outwards.y(), normal.y()};
}

// Adds the vertices of a grid of `rows` x `columns` quads, which are split into triangles. The
// common vertices of neighbouring faces of a cube have the same bits, so no ray passes between the
// faces.
void AddGrid(int rows, int columns, const std::function<Vector3d(double, double)>& point,
             TriangleMesh& mesh) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  for (int r = 0; r <= rows; ++r) {
    for (int c = 0; c <= columns; ++c) {
      mesh.vertices.push_back(
          point(static_cast<double>(r) / rows, static_cast<double>(c) / columns));
    }
  }
  const auto index = [&](int r, int c) {
    return first + static_cast<uint32_t>(r * (columns + 1) + c);
  };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      mesh.triangles.push_back({index(r, c), index(r, c + 1), index(r + 1, c + 1)});
      mesh.triangles.push_back({index(r, c), index(r + 1, c + 1), index(r + 1, c)});
    }
  }
}

// A cube with six faces of `steps` x `steps` quads, whose vertices are moved by `map`. The grid
// lines are spaced by a tangent, so that they are evenly spaced in angle on a sphere.
TriangleMesh CubeMesh(int steps, const std::function<Vector3d(const Vector3d&)>& map) {
  TriangleMesh mesh;
  const auto spread = [](double fraction) {
    const double t = 2.0 * fraction - 1.0;  // exact at both ends, so that the faces join
    return std::abs(t) == 1.0 ? t : std::tan(std::numbers::pi / 4.0 * t);
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      AddGrid(
          steps, steps,
          [&](double r, double c) {
            Vector3d cube;
            cube[axis] = side;
            cube[(axis + 1) % 3] = spread(r);
            cube[(axis + 2) % 3] = spread(c);
            return map(cube);
          },
          mesh);
    }
  }
  return mesh;
}

// The number of quads along a quarter of a circle with a radius of `half` metres for which the
// chords stay within `kMaxError` of the circle. It is even, so that the ends of the axes are
// vertices.
int SphereSteps(double half) {
  const double angle = std::sqrt(8.0 * kMaxError / half);
  return 2 * static_cast<int>(std::ceil(0.25 * std::numbers::pi / angle));
}

TriangleMesh CylinderMesh(const Shape& shape) {
  TriangleMesh mesh;
  const auto circle = [&](double fraction, double radius, double z) {
    const double angle = kFullTurn * (fraction < 1.0 ? fraction : 0.0);
    return Vector3d(radius * shape.half.x() * std::cos(angle),
                    radius * shape.half.y() * std::sin(angle), z);
  };
  constexpr int kSegments = 192;
  const double h = shape.half.z();
  AddGrid(
      1, kSegments, [&](double r, double c) { return circle(c, 1.0, h * (2.0 * r - 1.0)); }, mesh);
  AddGrid(
      1, kSegments, [&](double r, double c) { return circle(c, r, -h); }, mesh);
  AddGrid(
      1, kSegments, [&](double r, double c) { return circle(c, r, h); }, mesh);
  return mesh;
}

TriangleMesh TorusMesh(const Shape& shape) {
  TriangleMesh mesh;
  const double ring = shape.half.x() - shape.tube;
  AddGrid(
      128, 48,
      [&](double r, double c) {
        const double around = kFullTurn * (r < 1.0 ? r : 0.0);
        const double across = kFullTurn * (c < 1.0 ? c : 0.0);
        const double radius = ring + shape.tube * std::cos(across);
        return Vector3d(radius * std::cos(around), shape.tube * std::sin(across),
                        radius * std::sin(around));
      },
      mesh);
  return mesh;
}

TriangleMesh RevolvedMesh(const Shape& shape) {
  TriangleMesh mesh;
  constexpr int kSegments = 144;
  for (size_t i = 1; i < shape.profile.size(); ++i) {
    const Vector2d& from = shape.profile[i - 1];
    const Vector2d& to = shape.profile[i];
    AddGrid(
        1, kSegments,
        [&](double r, double c) {
          const Vector2d& at = r < 0.5 ? from : to;
          const double angle = kFullTurn * (c < 1.0 ? c : 0.0);
          return Vector3d(at.x() * std::cos(angle), at.x() * std::sin(angle), at.y());
        },
        mesh);
  }
  return mesh;
}

}  // namespace

Shape Shape::Box(const Vector3d& half) { return {.kind = ShapeKind::kBox, .half = half}; }

Shape Shape::Ellipsoid(const Vector3d& half) {
  return {.kind = ShapeKind::kEllipsoid, .half = half};
}

Shape Shape::Superquadric(const Vector3d& half, double north, double east) {
  return {.kind = ShapeKind::kSuperquadric, .half = half, .north = north, .east = east};
}

Shape Shape::Cylinder(double radius, double half_height) {
  return {.kind = ShapeKind::kCylinder, .half = {radius, radius, half_height}};
}

Shape Shape::Torus(double ring, double tube) {
  return {.kind = ShapeKind::kTorus, .half = {ring + tube, tube, ring + tube}, .tube = tube};
}

Shape Shape::Revolved(std::vector<Vector2d> profile) {
  Check(profile.size() >= 3 && profile.front().x() == 0.0 && profile.back().x() == 0.0,
        "the profile of a solid of revolution begins and ends at the axis");
  Eigen::AlignedBox2d box;
  for (const Vector2d& point : profile) {
    Check(point.x() >= 0.0, "the profile of a solid of revolution is on one side of the axis");
    box.extend(point);
  }
  for (Vector2d& point : profile) {
    point.y() -= box.center().y();
  }
  const double radius = box.max().x();
  return {.kind = ShapeKind::kRevolved,
          .half = {radius, radius, 0.5 * box.sizes().y()},
          .profile = std::move(profile)};
}

Vector3d Shape::Normal(const Vector3d& point) const {
  const Vector3d q = point.cwiseQuotient(half);
  switch (kind) {
    case ShapeKind::kBox:
      return BoxNormal(q);
    case ShapeKind::kEllipsoid:
      return q.cwiseQuotient(half).normalized();
    case ShapeKind::kSuperquadric:
      return SuperquadricNormal(*this, q).normalized();
    case ShapeKind::kCylinder:
      return CylinderNormal(q).normalized();
    case ShapeKind::kTorus:
      return TorusNormal(*this, point).normalized();
    case ShapeKind::kRevolved:
      return RevolvedNormal(*this, point).normalized();
  }
  throw CheckError("unknown kind of shape");
}

TriangleMesh Tessellate(const Shape& shape) {
  const int steps = SphereSteps(shape.half.maxCoeff());
  switch (shape.kind) {
    case ShapeKind::kBox:
      return CubeMesh(
          1, [&](const Vector3d& cube) -> Vector3d { return shape.half.cwiseProduct(cube); });
    case ShapeKind::kEllipsoid:
      return CubeMesh(steps, [&](const Vector3d& cube) -> Vector3d {
        return shape.half.cwiseProduct(cube.normalized());
      });
    case ShapeKind::kSuperquadric:
      return CubeMesh(steps, [&](const Vector3d& cube) -> Vector3d {
        const double radius = std::pow(SuperquadricSum(shape, cube), -shape.north / 2.0);
        return shape.half.cwiseProduct(radius * cube);
      });
    case ShapeKind::kCylinder:
      return CylinderMesh(shape);
    case ShapeKind::kTorus:
      return TorusMesh(shape);
    case ShapeKind::kRevolved:
      return RevolvedMesh(shape);
  }
  throw CheckError("unknown kind of shape");
}

}  // namespace hullslam::synthetic

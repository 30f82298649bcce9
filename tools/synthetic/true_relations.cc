// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/true_relations.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "geometry/polygon.h"
#include "scene/object_body.h"
#include "synthetic/shape.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

constexpr double kContact = 0.005;      // m
constexpr int kRays = 64;               // horizontal ones, around an object
constexpr double kSurrounded = 0.75;    // least share of the rays that hit
constexpr size_t kMostFeet = 64;        // lowest points of an object that are tried
constexpr double kMostBesideGap = 1.0;  // of the mean width, as in scene/relations.cc

// The exact surface of an object in the world.
struct SolidObject {
  const SceneObject* object = nullptr;
  std::vector<std::array<Vector3d, 3>> triangles;
  std::vector<Vector3d> feet;  // points of the surface at its lowest height
  ObjectBody body;             // its footprint and its heights are exact
};

// Adds the triangles of a part, in the world. Returns its vertices.
std::vector<Vector3d> AddPart(const SceneObject& object, const Part& part, SolidObject& solid) {
  const TriangleMesh mesh = Tessellate(part.shape);
  const Rigid3 world_from_part = object.world_from_object * part.owner_from_part;
  std::vector<Vector3d> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const Vector3d& vertex : mesh.vertices) {
    vertices.push_back(world_from_part * vertex);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    solid.triangles.push_back({vertices[a], vertices[b], vertices[c]});
  }
  return vertices;
}

// The lowest vertices, and the middles of the triangles between them: a box that stands on a
// smaller one touches it with no vertex.
std::vector<Vector3d> FindFeet(const SolidObject& solid, const std::vector<Vector3d>& vertices,
                               double bottom) {
  const auto is_low = [&](const Vector3d& point) { return point.z() <= bottom + kContact; };
  std::vector<Vector3d> feet;
  std::copy_if(vertices.begin(), vertices.end(), std::back_inserter(feet), is_low);
  const size_t step = std::max<size_t>(1, feet.size() / kMostFeet);
  std::vector<Vector3d> chosen;
  for (size_t i = 0; i < feet.size(); i += step) {
    chosen.push_back(feet[i]);
  }
  for (const auto& triangle : solid.triangles) {
    if (chosen.size() < 2 * kMostFeet && std::all_of(triangle.begin(), triangle.end(), is_low)) {
      chosen.push_back((triangle[0] + triangle[1] + triangle[2]) / 3.0);
    }
  }
  return chosen;
}

SolidObject MakeSolidObject(const SceneObject& object) {
  SolidObject solid;
  solid.object = &object;
  std::vector<Vector3d> points;
  for (const Part& part : object.parts) {
    const std::vector<Vector3d> vertices = AddPart(object, part, solid);
    points.insert(points.end(), vertices.begin(), vertices.end());
  }
  std::vector<Eigen::Vector2d> outline;
  double bottom = std::numeric_limits<double>::max();
  double top = std::numeric_limits<double>::lowest();
  for (const Vector3d& point : points) {
    outline.emplace_back(point.head<2>());
    bottom = std::min(bottom, point.z());
    top = std::max(top, point.z());
  }
  solid.feet = FindFeet(solid, points, bottom);
  solid.body.id = ObjectId(static_cast<uint32_t>(object.id));
  solid.body.footprint = ConvexHull(outline);
  solid.body.bottom = bottom;
  solid.body.top = top;
  const UprightBox box = BoxOf(solid.body, Eigen::Quaterniond::Identity());
  solid.body.size = 2.0 * box.half_extents.mean();
  solid.body.width = box.half_extents.head<2>().sum();
  return solid;
}

// The distance to a triangle along a ray with a unit direction; nothing if it misses (Moeller and
// Trumbore 1997).
std::optional<double> HitTriangle(const Vector3d& origin, const Vector3d& direction,
                                  const std::array<Vector3d, 3>& triangle) {
  const Vector3d ab = triangle[1] - triangle[0];
  const Vector3d ac = triangle[2] - triangle[0];
  const Vector3d across = direction.cross(ac);
  const double determinant = ab.dot(across);
  if (std::abs(determinant) < 1e-15) {
    return std::nullopt;
  }
  const Vector3d offset = origin - triangle[0];
  const double u = offset.dot(across) / determinant;
  const Vector3d other = offset.cross(ab);
  const double v = direction.dot(other) / determinant;
  const double distance = ac.dot(other) / determinant;
  const bool is_hit = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance >= 0.0;
  return is_hit ? std::optional(distance) : std::nullopt;
}

bool Hits(const Vector3d& origin, const Vector3d& direction, double most,
          const SolidObject& solid) {
  return std::any_of(solid.triangles.begin(), solid.triangles.end(), [&](const auto& triangle) {
    const auto distance = HitTriangle(origin, direction, triangle);
    return distance && *distance <= most;
  });
}

bool Touches(const SolidObject& a, const SolidObject& b) {
  return std::any_of(a.feet.begin(), a.feet.end(), [&](const Vector3d& foot) {
    const Vector3d above = foot + kContact * Vector3d::UnitZ();
    return Hits(above, -Vector3d::UnitZ(), 2.0 * kContact, b);
  });
}

bool IsSurrounded(const SolidObject& a, const SolidObject& b) {
  constexpr double kFar = 1e3;  // m
  const Vector3d& center = a.object->world_from_object.translation;
  int hits = 0;
  for (int i = 0; i < kRays; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kRays;
    hits += Hits(center, {std::cos(angle), std::sin(angle), 0.0}, kFar, b) ? 1 : 0;
  }
  return hits >= kSurrounded * kRays;
}

std::optional<size_t> SupportUnder(const SolidObject& a, const std::vector<Support>& supports) {
  for (size_t i = 0; i < supports.size(); ++i) {
    const Support& support = supports[i];
    if (std::abs(a.body.bottom - support.height) > kContact) {
      continue;
    }
    const bool is_over = std::any_of(a.feet.begin(), a.feet.end(), [&](const Vector3d& foot) {
      return (foot.head<2>().array() >= support.min.array()).all() &&
             (foot.head<2>().array() <= support.max.array()).all();
    });
    if (is_over) {
      return i;
    }
  }
  return std::nullopt;
}

// The relation of the object to the thing that it stands in or on.
std::optional<TrueRelation> FindStand(const SolidObject& a, const std::vector<SolidObject>& all,
                                      const std::vector<Support>& supports) {
  for (const SolidObject& b : all) {
    if (&a != &b && a.body.bottom > b.body.bottom + kContact &&
        FootprintGap(a.body, b.body) < 0.0 && Touches(a, b)) {
      return TrueRelation{a.object->id, IsSurrounded(a, b) ? "in" : "on", b.object->id, {}};
    }
  }
  if (const auto support = SupportUnder(a, supports)) {
    return TrueRelation{a.object->id, "on", {}, support};
  }
  return std::nullopt;
}

bool IsSameStand(const TrueRelation& a, const TrueRelation& b) {
  return a.object == b.object && a.support == b.support;
}

}  // namespace

std::vector<TrueRelation> FindTrueRelations(const Scene& scene) {
  std::vector<SolidObject> solids;
  for (const SceneObject& object : scene.objects) {
    if (!object.IsDynamic()) {
      solids.push_back(MakeSolidObject(object));
    }
  }
  std::vector<std::optional<TrueRelation>> stands;
  stands.reserve(solids.size());
  for (const SolidObject& solid : solids) {
    stands.push_back(FindStand(solid, solids, scene.supports));
  }
  std::vector<TrueRelation> relations;
  for (size_t i = 0; i < solids.size(); ++i) {
    if (!stands[i]) {
      continue;
    }
    relations.push_back(*stands[i]);
    for (size_t k = 0; k < solids.size(); ++k) {
      const ObjectBody& a = solids[i].body;
      const ObjectBody& b = solids[k].body;
      if (i != k && stands[k] && IsSameStand(*stands[i], *stands[k]) &&
          FootprintGap(a, b) <= kMostBesideGap * 0.5 * (a.width + b.width)) {
        relations.push_back({solids[i].object->id, "beside", solids[k].object->id, {}});
      }
    }
  }
  return relations;
}

}  // namespace hullslam::synthetic

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/util/id.h"

namespace hullslam {

// The scene is the map as a person would describe it: things, and how they stand to each other
// (docs/scene.md). Coordinates are as in the map, lengths are in its unit (m with depth).

// A box around an object, with the z axis of its frame upwards.
struct UprightBox {
  Rigid3 world_from_box;  // the origin is the centre of the box
  Eigen::Vector3d half_extents = Eigen::Vector3d::Zero();
  // Whether the masks limit the side at -x, +x, -y, +y, -z, +z of its frame (box_fit.h).
  std::array<bool, 6> is_seen = {};
};

// What the masks leave free at an axis of an ellipsoid (shape_covariance.h).
struct FreeAxis {
  bool is_round = false;         // turning about it changes nothing
  bool is_undetermined = false;  // the length of its half axis is not determined
};

// How well the shape of an object is known.
struct ShapeCovariance {
  Eigen::Matrix3d center = Eigen::Matrix3d::Zero();     // m^2, world axes
  Eigen::Matrix3d half_axes = Eigen::Matrix3d::Zero();  // m^2, in the order of the half axes
  std::array<FreeAxis, 3> axes = {};                    // likewise
};

struct SceneObject {
  ObjectId id;
  std::string label;                     // the class with most votes
  std::map<std::string, double> shares;  // share of the votes by class; the sum is 1
  Ellipsoid ellipsoid;                   // world frame
  std::optional<UprightBox> box;         // absent if the upward direction is not known
  std::optional<ShapeCovariance> covariance;
  size_t observations = 0;  // number of keyframes that observe it
  double first_seen = 0.0;  // s, time stamps of the first and the last of them
  double last_seen = 0.0;
  double quality = 0.0;  // QualityOf()
  // Its appearance: the mean of the vectors of its masks, weighted by their scores, with length
  // 1. Empty if no mask has a vector.
  std::vector<float> embedding = {};
};

enum class RelationKind { kOn, kIn, kBeside, kInFrontOf, kSupports, kPartOf, kHiddenBy };
inline constexpr size_t kRelationKinds = 7;

// The names in files, such as "in front of".
std::string_view ToString(RelationKind kind);
// Nothing for a text that is no name of ToString().
std::optional<RelationKind> ParseRelationKind(std::string_view name);

// A measured value that a relation is based on: "gap", "overlap", "views", ...
using Evidence = std::vector<std::pair<std::string, double>>;

// "cup 3 on book 5": the subject is the cup.
struct Relation {
  ObjectId subject;
  RelationKind kind = RelationKind::kBeside;
  ObjectId object;
  Evidence evidence;
};

// A horizontal surface on which objects stand, such as the floor or a table. It is known only by
// these objects.
struct Surface {
  double height = 0.0;            // m, along `up`
  bool is_lowest = false;         // nothing was seen to stand lower: it is probably the floor
  std::vector<ObjectId> objects;  // by increasing id; at least two
};

struct Scene {
  std::optional<Eigen::Vector3d> up;  // unit vector, world frame
  std::string up_from;                // where it is from; why it is not known
  std::vector<SceneObject> objects;   // the mapped objects, by increasing id
  std::vector<Relation> relations;
  std::vector<Surface> surfaces;  // by increasing height

  // Null if the scene does not have the object.
  const SceneObject* Find(ObjectId id) const;
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/trajectory.h"
#include "results/unit_mesh.h"
#include "scene/scene.h"

namespace hullslam {

struct ColouredPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // world frame
  Colour colour{};                                     // sRGB
};

// A run or a map, as far as pictures of it and lists of poses need it. Positions are in the world
// frame of the map and in its unit of length (m with depth).
struct ExportModel {
  std::optional<PinholeCamera> camera;  // absent if the files of the run do not have it
  Trajectory trajectory;                // all frames with a pose; of a map only the keyframes
  std::vector<StampedPose> keyframes;   // in the order of the map
  std::vector<ColouredPoint> points;
  Scene scene;  // the mapped objects and the upward direction
};

enum class ObjectShape { kEllipsoids, kBoxes };

// The position of an object's shape: the unit sphere or the unit cube (results/unit_mesh.h) is
// multiplied by `half_extents` along its axes and then moved to the world.
struct PlacedObject {
  const SceneObject* object = nullptr;
  Rigid3 world_from_shape;
  Eigen::Vector3d half_extents = Eigen::Vector3d::Ones();
};

// The objects as shapes of this kind, in the order of the scene. A box is the upright one of the
// scene; if the scene does not know what is upwards, it is the box around the ellipsoid along the
// axes of the ellipsoid. The scene must outlive the result.
std::vector<PlacedObject> PlaceObjects(const Scene& scene, ObjectShape shape);

// The mesh that such a shape is made from.
TriangleMesh MeshOf(ObjectShape shape);

}  // namespace hullslam

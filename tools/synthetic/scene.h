// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "synthetic/shape.h"
#include "synthetic/texture.h"

namespace hullslam::synthetic {

// The appearance of a surface. The texture lies on the three coordinate planes of the frame of the
// part; each point uses the plane whose normal is nearest to its own. On vertical sides the texture
// is upright along z.
struct Material {
  int texture = 0;                                   // index in Scene::textures
  Eigen::Vector3f tile = Eigen::Vector3f::Ones();    // metres per repeat along the axes
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();  // metres
  Eigen::Vector3f tint = Eigen::Vector3f::Ones();    // factor on B, G, R
};

// One primitive solid, in the frame of its owner: an object, or the world for the background.
struct Part {
  Shape shape;
  Material material;
  Rigid3 owner_from_part;
};

// The change of an object by a rearrangement.
enum class ObjectStatus { kUnchanged, kMoved, kNew };

// An object that a segmentation network would find, or a thing without a class, which gets no mask.
struct SceneObject {
  static constexpr int kNoClass = -1;
  int id = 0;              // the same before and after a rearrangement
  std::string class_name;  // name of COCO; empty without a class
  int class_id = 0;        // id of COCO, counted from 0, or kNoClass
  std::string shape;       // "ellipsoid", "box", "cylinder", "superquadric" or "compound"
  std::vector<Part> parts;
  Eigen::Vector3d half_extents =
      Eigen::Vector3d::Zero();  // tight, in the frame of the object, metres
  Rigid3 world_from_object;     // at time 0
  // Pose of a moving object at a time in seconds; empty for a static object.
  std::function<Rigid3(double)> motion;
  ObjectStatus status = ObjectStatus::kUnchanged;
  Rigid3 former_world_from_object;  // only of a moved object: pose before the rearrangement

  bool HasClass() const { return class_id != kNoClass; }
  bool IsDynamic() const { return static_cast<bool>(motion); }
  Rigid3 WorldFromObject(double time) const { return motion ? motion(time) : world_from_object; }
};

struct PointLight {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  float strength = 1.0F;  // on a surface at a distance of 1 m that faces the light
};

// A horizontal rectangle on which objects can stand: a floor or the top of a table. Metres.
struct Support {
  Eigen::Vector2d min = Eigen::Vector2d::Zero();
  Eigen::Vector2d max = Eigen::Vector2d::Zero();
  double height = 0.0;  // 0 for a floor
};

// A closed room (every ray hits something) with objects, and the path of the camera in it. The
// world frame has z up, in metres.
struct Scene {
  std::vector<Texture> textures;
  std::vector<Part> background;
  std::vector<Support> supports;
  std::vector<SceneObject> objects;
  std::vector<SceneObject> gone;  // objects that a rearrangement took away, with their former poses
  std::vector<PointLight> lights;
  float ambient = 0.5F;
  std::function<Rigid3(double)> world_from_cam;  // as a function of the time in seconds
};

}  // namespace hullslam::synthetic

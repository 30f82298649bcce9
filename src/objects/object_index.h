// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"

namespace hullslam {

// The locations of the objects of a map, as a list of spheres: one around the ellipsoid of each
// object and one around its hull in its last observation. Finding the objects in an image takes a
// few nanoseconds per object. The index does not follow changes of the map.
class ObjectIndex {
 public:
  ObjectIndex() = default;
  ObjectIndex(const Map& map, const PinholeCamera& camera);

  // Makes this the index of `snapshot`, unless it is already.
  void Follow(const Map& snapshot, const PinholeCamera& camera);

  // The objects of an island that a camera at this pose may see: all whose projected ellipse or
  // last hull, moved to this pose, reaches into the image, and a few more. They include objects
  // whose location is not known. By increasing id.
  std::vector<ObjectId> FindVisible(const Sensor& sensor, const Rigid3& cam_from_world,
                                    IslandId island) const;

 private:
  struct Sphere {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  // m, world frame
    double radius = 0.0;                               // m; infinite if the location is not known
    ObjectId object;
    IslandId island;
  };

  void Add(const Map& map, const PinholeCamera& camera, ObjectId id, const ObjectLandmark& object);

  std::vector<Sphere> spheres_;  // by increasing id of the object
  uint32_t revision_ = 0;        // revision of the map; 0 if it was no snapshot
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"

namespace hullslam {

// Where the objects of a map are, as a list of spheres: one around the ellipsoid of an object and
// one around what its last view shows. To find the objects in an image costs a few nanoseconds per
// object. The index does not follow changes of the map.
class ObjectIndex {
 public:
  ObjectIndex() = default;
  ObjectIndex(const Map& map, const PinholeCamera& camera);

  // Makes the index that of `snapshot`, unless it is already.
  void Follow(const Map& snapshot, const PinholeCamera& camera);

  // The objects of an island that a camera there may see: all whose projected ellipse or last hull,
  // moved to this pose, reaches into the image, and a few more. Objects whose place is not known
  // are among them. By increasing id.
  std::vector<ObjectId> FindVisible(const Sensor& sensor, const Rigid3& cam_from_world,
                                    IslandId island) const;

 private:
  struct Sphere {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  // m, world frame
    double radius = 0.0;                               // m; infinite if the place is not known
    ObjectId object;
    IslandId island;
  };

  void Add(const Map& map, const PinholeCamera& camera, ObjectId id, const ObjectLandmark& object);

  std::vector<Sphere> spheres_;  // by increasing id of the object
  uint32_t revision_ = 0;        // of the map; 0 if it was no snapshot
};

}  // namespace hullslam

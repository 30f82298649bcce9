// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/object_index.h"

#include <algorithm>
#include <array>
#include <limits>

#include "map/islands.h"
#include "objects/constraint/point_statistics.h"
#include "objects/resolved_observation.h"

namespace hullslam {
namespace {

// A projected ellipse is drawn as a polygon with the same area, so its corners lie outside.
constexpr double kMargin = 1.05;
// The ellipse of an object that nearly reaches the plane of the camera is huge, and so is the
// difference between it and the polygon. Such an object counts as visible. In radii of the sphere.
constexpr double kNearPlane = 1.2;

// The part of space that an image shows, in the frame of the camera.
class Frustum {
 public:
  explicit Frustum(const Sensor& sensor) {
    const PinholeCamera& camera = sensor.camera;
    const PinholeCamera::Bounds& bounds = sensor.bounds;
    inwards_ = {Eigen::Vector3d::UnitZ(),
                Eigen::Vector3d(camera.fx, 0.0, camera.cx - bounds.min_x).normalized(),
                Eigen::Vector3d(-camera.fx, 0.0, bounds.max_x - camera.cx).normalized(),
                Eigen::Vector3d(0.0, camera.fy, camera.cy - bounds.min_y).normalized(),
                Eigen::Vector3d(0.0, -camera.fy, bounds.max_y - camera.cy).normalized()};
  }

  // False only if the sphere is outside.
  bool MayMeet(const Eigen::Vector3d& center, double radius) const {
    if (center.z() < kNearPlane * radius) {
      return center.z() > -radius;
    }
    return std::all_of(inwards_.begin(), inwards_.end(), [&](const Eigen::Vector3d& inwards) {
      return inwards.dot(center) >= -radius;
    });
  }

 private:
  std::array<Eigen::Vector3d, 5> inwards_;  // normals of the planes through the camera's centre
};

}  // namespace

ObjectIndex::ObjectIndex(const Map& map, const PinholeCamera& camera) : revision_(map.revision()) {
  spheres_.reserve(2 * map.objects().size());
  for (const auto& [id, object] : map.objects()) {
    if (!object.observations.empty()) {
      Add(map, camera, id, object);
    }
  }
}

void ObjectIndex::Follow(const Map& snapshot, const PinholeCamera& camera) {
  const bool is_snapshot = snapshot.revision() != 0;  // any other map may have changed
  if (!is_snapshot || snapshot.revision() != revision_) {
    *this = ObjectIndex(snapshot, camera);
  }
}

void ObjectIndex::Add(const Map& map, const PinholeCamera& camera, ObjectId id,
                      const ObjectLandmark& object) {
  const IslandId island = IslandOf(map, object);
  if (object.has_shape) {
    spheres_.push_back({object.ellipsoid.world_from_object.translation,
                        kMargin * object.ellipsoid.half_axes.maxCoeff(), id, island});
  }
  const ResolvedObservation last = LatestObservations(map, object, 1).front();
  const Eigen::AlignedBox2d& box = last.detection->box;
  if (last.detection->points.empty() || box.isEmpty()) {
    spheres_.push_back(
        {Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity(), id, island});
    return;
  }
  // The hull at the depth of its points, as association carries it to another frame.
  const double depth = MeanOf(last.detection->points.Unpack()).z();
  const auto unproject = [&](const Eigen::Vector2d& pixel) {
    return camera.Unproject(pixel, depth);
  };
  spheres_.push_back({Inverse(last.cam_from_world) * unproject(box.center()),
                      kMargin * 0.5 * (unproject(box.max()) - unproject(box.min())).norm(), id,
                      island});
}

std::vector<ObjectId> ObjectIndex::FindVisible(const Sensor& sensor, const Rigid3& cam_from_world,
                                               IslandId island) const {
  const Frustum volume(sensor);
  std::vector<ObjectId> visible;
  for (const Sphere& sphere : spheres_) {
    const bool is_new = visible.empty() || visible.back() != sphere.object;
    if (is_new && sphere.island == island &&
        volume.MayMeet(cam_from_world * sphere.center, sphere.radius)) {
      visible.push_back(sphere.object);
    }
  }
  return visible;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "synthetic/scene.h"

namespace hullslam::synthetic {

// A part with the object it belongs to (index in Scene::objects), -1 for the background.
struct PlacedPart {
  const Part* part = nullptr;
  int object = -1;
};

// Eight rays with a common origin, cast together for speed.
struct RayPacket {
  static constexpr int kSize = 8;
  std::array<Eigen::Vector3f, kSize> direction;  // world frame, of any length
  std::array<float, kSize> distance{};           // to the first hit, in lengths of `direction`
  std::array<int, kSize> part{};                 // index in RayCaster::parts(), -1 for no hit
};

// First hits of rays with a scene, by Embree. All static parts are one acceleration structure;
// each moving object has its own in its own frame and rays are brought there, so that frames at
// different times can be cast by different threads at once. The same rays give the same bits.
class RayCaster {
 public:
  // Keeps a reference to `scene`.
  explicit RayCaster(const Scene& scene);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  // The background's parts first, then those of the objects in order.
  std::span<const PlacedPart> parts() const { return parts_; }
  // Fills distance and part of `packet`. `world_from_object` holds the pose of every object.
  void Cast(const Eigen::Vector3f& origin, std::span<const Rigid3> world_from_object,
            RayPacket& packet) const;

 private:
  struct Device;
  std::vector<PlacedPart> parts_;
  std::unique_ptr<Device> device_;
};

}  // namespace hullslam::synthetic

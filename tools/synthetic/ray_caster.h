// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "synthetic/scene.h"

namespace hullslam::synthetic {

// A part and the index of its object in Scene::objects, -1 for the background.
struct PlacedPart {
  const Part* part = nullptr;
  int object = -1;
};

// Eight rays with a common origin, which are cast together for speed.
struct RayPacket {
  static constexpr int kSize = 8;
  std::array<Eigen::Vector3f, kSize> direction;  // world frame, of any length
  std::array<float, kSize> distance{};  // to the first hit, in units of the length of `direction`
  std::array<int, kSize> part{};        // index in RayCaster::parts(), -1 for no hit
};

// Finds the first hits of rays with a scene, by Embree. All static parts share one acceleration
// structure. Each moving object has its own one in its own frame, and rays are transformed to this
// frame, so that several threads can cast frames of different times at once. The same rays give
// bit-identical results on all kinds of processors.
class RayCaster {
 public:
  // Keeps a reference to `scene`. `embree_options` are those of rtcNewDevice(); they change nothing
  // but the speed.
  explicit RayCaster(const Scene& scene, const std::string& embree_options = "threads=1");
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  // First the parts of the background, then the parts of the objects in order.
  std::span<const PlacedPart> parts() const { return parts_; }
  // Fills in distance and part of `packet`. `world_from_object` has the pose of each object.
  void Cast(const Eigen::Vector3f& origin, std::span<const Rigid3> world_from_object,
            RayPacket& packet) const;

 private:
  struct Device;
  std::vector<PlacedPart> parts_;
  std::unique_ptr<Device> device_;
};

}  // namespace hullslam::synthetic

// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/ray_caster.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release>;

struct Mover {
  int object = 0;
  SceneHandle scene;
};

// Copies the triangles of the part, in the frame of `frame_from_part`, to the scene under `id`.
void Attach(RTCDevice device, RTCScene scene, const Part& part, const Rigid3& frame_from_part,
            unsigned id) {
  const TriangleMesh mesh = Tessellate(part.shape);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.vertices.size()));
  auto* triangles = static_cast<uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(uint32_t), mesh.triangles.size()));
  Check(vertices != nullptr && triangles != nullptr, "Embree has no memory for a mesh");
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    Eigen::Map<Eigen::Vector3f>(vertices + 3 * i) =
        (frame_from_part * mesh.vertices[i]).cast<float>();
  }
  std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(uint32_t));
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

SceneHandle NewScene(RTCDevice device) {
  SceneHandle scene(rtcNewScene(device));
  // In robust mode no ray passes between neighbouring triangles.
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  return scene;
}

// Casts the rays of the packet, given in the frame of `scene`, and keeps hits that are nearer than
// those in the packet.
void CastIn(RTCScene scene, const Eigen::Vector3f& origin,
            const std::array<Eigen::Vector3f, RayPacket::kSize>& direction, RayPacket& packet) {
  RTCRayHit8 query{};
  alignas(32) std::array<int, RayPacket::kSize> valid{};
  valid.fill(-1);
  for (size_t i = 0; i < RayPacket::kSize; ++i) {
    query.ray.org_x[i] = origin.x();
    query.ray.org_y[i] = origin.y();
    query.ray.org_z[i] = origin.z();
    query.ray.dir_x[i] = direction[i].x();
    query.ray.dir_y[i] = direction[i].y();
    query.ray.dir_z[i] = direction[i].z();
    query.ray.tnear[i] = 0.0F;
    query.ray.tfar[i] = packet.distance[i];
    query.ray.time[i] = 0.0F;
    query.ray.mask[i] = ~0U;
    query.ray.id[i] = static_cast<unsigned>(i);
    query.ray.flags[i] = 0;
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context{};
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid.data(), scene, &context, &query);
  for (size_t i = 0; i < RayPacket::kSize; ++i) {
    if (query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) {
      packet.distance[i] = query.ray.tfar[i];
      packet.part[i] = static_cast<int>(query.hit.geomID[i]);
    }
  }
}

}  // namespace

struct RayCaster::Device {
  DeviceHandle device;
  SceneHandle still;
  std::vector<Mover> movers;
};

RayCaster::RayCaster(const Scene& scene) : device_(std::make_unique<Device>()) {
  // One thread only, because the acceleration structure must not depend on the timing of several
  // threads. One set of instructions, because with others distances differ in their last digits,
  // and images would depend on the kind of processor. Every x86 processor of 64 bits has this one.
  device_->device.reset(rtcNewDevice("threads=1,isa=sse2"));
  Check(device_->device != nullptr, "Embree has no device on this machine");
  RTCDevice device = device_->device.get();
  device_->still = NewScene(device);
  for (const Part& part : scene.background) {
    Attach(device, device_->still.get(), part, part.owner_from_part,
           static_cast<unsigned>(parts_.size()));
    parts_.push_back({&part, -1});
  }
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (object.IsDynamic()) {
      device_->movers.push_back({static_cast<int>(i), NewScene(device)});
    }
    RTCScene target =
        object.IsDynamic() ? device_->movers.back().scene.get() : device_->still.get();
    const Rigid3 frame_from_object = object.IsDynamic() ? Rigid3() : object.world_from_object;
    for (const Part& part : object.parts) {
      Attach(device, target, part, frame_from_object * part.owner_from_part,
             static_cast<unsigned>(parts_.size()));
      parts_.push_back({&part, static_cast<int>(i)});
    }
    if (object.IsDynamic()) {
      rtcCommitScene(target);
    }
  }
  rtcCommitScene(device_->still.get());
  Check(rtcGetDeviceError(device) == RTC_ERROR_NONE, "Embree could not build the scene");
}

RayCaster::~RayCaster() = default;

void RayCaster::Cast(const Eigen::Vector3f& origin, std::span<const Rigid3> world_from_object,
                     RayPacket& packet) const {
  packet.distance.fill(std::numeric_limits<float>::infinity());
  packet.part.fill(-1);
  CastIn(device_->still.get(), origin, packet.direction, packet);
  for (const Mover& mover : device_->movers) {
    const Rigid3 object_from_world = Inverse(world_from_object[static_cast<size_t>(mover.object)]);
    const Eigen::Matrix3f turn = object_from_world.rotation.toRotationMatrix().cast<float>();
    std::array<Eigen::Vector3f, RayPacket::kSize> turned;
    std::transform(packet.direction.begin(), packet.direction.end(), turned.begin(),
                   [&](const Eigen::Vector3f& d) -> Eigen::Vector3f { return turn * d; });
    const Eigen::Vector3f start = (object_from_world * origin.cast<double>()).cast<float>();
    CastIn(mover.scene.get(), start, turned, packet);
  }
}

}  // namespace hullslam::synthetic

// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/ray_caster.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <deque>
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

// Embree leaves out boxes with approximate reciprocals. So the boxes around triangles are larger by
// this, m, which is far more than its rounding errors in scenes of 300 m.
constexpr double kMargin = 2e-4;

using Corners = std::array<Eigen::Vector3d, 3>;

Corners CornersOf(const TriangleMesh& mesh, unsigned triangle) {
  const std::array<uint32_t, 3>& corners = mesh.triangles[triangle];
  return {mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]};
}

void GetBounds(const RTCBoundsFunctionArguments* args) {
  const Corners corners =
      CornersOf(*static_cast<const TriangleMesh*>(args->geometryUserPtr), args->primID);
  const Eigen::Vector3f lower =
      (corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).array() - kMargin)
          .matrix()
          .cast<float>();
  const Eigen::Vector3f upper =
      (corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]).array() + kMargin)
          .matrix()
          .cast<float>();
  *args->bounds_o = {lower.x(), lower.y(), lower.z(), 0.0F, upper.x(), upper.y(), upper.z(), 0.0F};
}

// A triangle as rays from one origin see it.
struct SeenTriangle {
  SeenTriangle(const Corners& corners, const Eigen::Vector3d& origin) {
    const Corners at = {corners[0] - origin, corners[1] - origin, corners[2] - origin};
    for (size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d& next = at[(i + 1) % 3];
      edges[i] = (at[i] - next).cross(at[i] + next);
    }
    normal = (at[1] - at[0]).cross(at[2] - at[0]);
    offset = normal.dot(at[0]);
  }

  // The distance along the ray in units of the length of `direction`, infinity if the ray misses
  // the triangle. A ray that passes an edge between two triangles is on opposite sides of it for
  // the two, without rounding errors, so it never passes between them (Plücker coordinates).
  double DistanceAlong(const Eigen::Vector3d& direction) const {
    const double a = edges[0].dot(direction);
    const double b = edges[1].dot(direction);
    const double c = edges[2].dot(direction);
    const double slope = normal.dot(direction);
    const bool inside = (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
    return inside && slope != 0.0 ? offset / slope : std::numeric_limits<double>::infinity();
  }

  std::array<Eigen::Vector3d, 3> edges;  // normals of the planes through the origin and an edge
  Eigen::Vector3d normal;
  double offset = 0.0;
};

// Keeps the triangle for those rays of the packet which hit it first. Of two that are hit at the
// same distance the part with the lower index counts, so the order of the calls does not matter.
void Intersect(const RTCIntersectFunctionNArguments* args) {
  RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  const Eigen::Vector3f origin(RTCRayN_org_x(ray, args->N, 0), RTCRayN_org_y(ray, args->N, 0),
                               RTCRayN_org_z(ray, args->N, 0));  // that of all rays
  const SeenTriangle triangle(
      CornersOf(*static_cast<const TriangleMesh*>(args->geometryUserPtr), args->primID),
      origin.cast<double>());
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) {
      continue;
    }
    const Eigen::Vector3f direction(RTCRayN_dir_x(ray, args->N, i), RTCRayN_dir_y(ray, args->N, i),
                                    RTCRayN_dir_z(ray, args->N, i));
    const auto distance = static_cast<float>(triangle.DistanceAlong(direction.cast<double>()));
    float& nearest = RTCRayN_tfar(ray, args->N, i);
    unsigned& part = RTCHitN_geomID(hit, args->N, i);
    if (distance >= 0.0F && (distance < nearest || (distance == nearest && args->geomID < part))) {
      nearest = distance;
      part = args->geomID;
    }
  }
}

// Puts the triangles of the part, in the frame of `frame_from_part`, into the scene under `id`.
// Embree finds the triangles near a ray; whether and where the ray hits them is computed here,
// because the results of Embree differ in their last digits between kinds of processors, and images
// with them. `mesh` must live as long as the scene.
void Attach(RTCDevice device, RTCScene scene, const Part& part, const Rigid3& frame_from_part,
            unsigned id, TriangleMesh& mesh) {
  mesh = Tessellate(part.shape);
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = frame_from_part * vertex;
  }
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(mesh.triangles.size()));
  rtcSetGeometryUserData(geometry, &mesh);
  rtcSetGeometryBoundsFunction(geometry, GetBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, Intersect);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
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
  RTCIntersectContext context{};  // not for coherent rays: these miss boxes along an axis
  rtcInitIntersectContext(&context);
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
  std::deque<TriangleMesh> meshes;  // one per part
  DeviceHandle device;
  SceneHandle still;
  std::vector<Mover> movers;
};

RayCaster::RayCaster(const Scene& scene, const std::string& embree_options)
    : device_(std::make_unique<Device>()) {
  device_->device.reset(rtcNewDevice(embree_options.c_str()));
  Check(device_->device != nullptr, "Embree has no device on this machine");
  RTCDevice device = device_->device.get();
  device_->still.reset(rtcNewScene(device));
  for (const Part& part : scene.background) {
    Attach(device, device_->still.get(), part, part.owner_from_part,
           static_cast<unsigned>(parts_.size()), device_->meshes.emplace_back());
    parts_.push_back({&part, -1});
  }
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (object.IsDynamic()) {
      device_->movers.push_back({static_cast<int>(i), SceneHandle(rtcNewScene(device))});
    }
    RTCScene target =
        object.IsDynamic() ? device_->movers.back().scene.get() : device_->still.get();
    const Rigid3 frame_from_object = object.IsDynamic() ? Rigid3() : object.world_from_object;
    for (const Part& part : object.parts) {
      Attach(device, target, part, frame_from_object * part.owner_from_part,
             static_cast<unsigned>(parts_.size()), device_->meshes.emplace_back());
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

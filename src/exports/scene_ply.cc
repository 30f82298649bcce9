// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/scene_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "files/byte_writer.h"
#include "util/median.h"

namespace hullslam {
namespace {

constexpr Colour kOrange = {255, 128, 0};

struct PlyBody {
  ByteWriter vertices;
  ByteWriter faces;
  uint32_t vertex_count = 0;
  size_t face_count = 0;
};

void AddVertex(const Eigen::Vector3d& position, const Colour& colour, PlyBody& body) {
  for (const double coordinate : position) {
    body.vertices.Put(static_cast<float>(coordinate));
  }
  for (const uint8_t channel : colour) {
    body.vertices.Put(channel);
  }
  ++body.vertex_count;
}

void AddPlyMesh(const TriangleMesh& mesh, const Rigid3& world_from_mesh,
                const Eigen::Vector3d& extents, const Colour& colour, PlyBody& body) {
  const uint32_t first = body.vertex_count;
  for (const Eigen::Vector3d& corner : mesh.corners) {
    AddVertex(world_from_mesh * corner.cwiseProduct(extents), colour, body);
  }
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    body.faces.Put(uint8_t{3});
    for (const uint32_t corner : triangle) {
      body.faces.Put(static_cast<int32_t>(first + corner));
    }
  }
  body.face_count += mesh.triangles.size();
}

std::string Finish(const PlyBody& body) {
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n",
      body.vertex_count);
  if (body.face_count > 0) {
    header +=
        fmt::format("element face {}\nproperty list uchar int vertex_indices\n", body.face_count);
  }
  return header + "end_header\n" + body.vertices.bytes() + body.faces.bytes();
}

// A pyramid of height 1 with its tip in the centre of the camera and the corners of the image at
// its open side.
TriangleMesh Pyramid(const PinholeCamera& camera) {
  TriangleMesh mesh{{Eigen::Vector3d::Zero()}, {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}}};
  const double width = camera.width;
  const double height = camera.height;
  for (const Eigen::Vector2d& pixel :
       std::array<Eigen::Vector2d, 4>{{{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}}}) {
    mesh.corners.push_back(camera.Unproject(pixel, 1.0));
  }
  return mesh;
}

// The height of the pyramids: a twentieth of the median distance of the points from the first
// camera, so that they can be seen and do not hide the scene.
double PyramidHeight(const ExportModel& model) {
  std::vector<double> distances;
  for (const ColouredPoint& point : model.points) {
    distances.push_back(
        (point.position - model.keyframes.front().world_from_cam.translation).norm());
  }
  return distances.empty() ? 0.1 : Median(distances) / 20.0;
}

void AddPyramids(const ExportModel& model, PlyBody& body) {
  if (model.keyframes.empty()) {
    return;
  }
  PinholeCamera usual;  // the shape of a common camera, if that of the run is not known
  usual.fx = usual.fy = usual.width;
  usual.cx = usual.width / 2.0;
  usual.cy = usual.height / 2.0;
  const TriangleMesh pyramid = Pyramid(model.camera.value_or(usual));
  const double height = PyramidHeight(model);
  for (const StampedPose& keyframe : model.keyframes) {
    AddPlyMesh(pyramid, keyframe.world_from_cam, Eigen::Vector3d::Constant(height), kOrange, body);
  }
}

}  // namespace

std::string FormatPointsPly(std::span<const ColouredPoint> points) {
  PlyBody body;
  for (const ColouredPoint& point : points) {
    AddVertex(point.position, point.colour, body);
  }
  return Finish(body);
}

std::string FormatScenePly(const ExportModel& model, ObjectShape shape) {
  PlyBody body;
  for (const ColouredPoint& point : model.points) {
    AddVertex(point.position, point.colour, body);
  }
  AddPyramids(model, body);
  const TriangleMesh mesh = MeshOf(shape);
  for (const PlacedObject& placed : PlaceObjects(model.scene, shape)) {
    AddPlyMesh(mesh, placed.world_from_shape, placed.half_extents,
               ColourOfClass(placed.object->label), body);
  }
  return Finish(body);
}

}  // namespace hullslam

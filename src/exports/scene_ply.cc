// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>

#include "exports/single_files.h"
#include "files/bytes.h"
#include "results/ply_file.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr Colour kOrange = {255, 128, 0};

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

void AddPyramids(const ExportModel& model, PlyWriter& file) {
  if (model.keyframes.empty()) {
    return;
  }
  PinholeCamera usual;  // the shape of a common camera, if the run's camera is not known
  usual.fx = usual.fy = usual.width;
  usual.cx = usual.width / 2.0;
  usual.cy = usual.height / 2.0;
  const TriangleMesh pyramid = Pyramid(model.camera.value_or(usual));
  const double height = PyramidHeight(model);
  for (const StampedPose& keyframe : model.keyframes) {
    file.AddMesh(pyramid, keyframe.world_from_cam, Eigen::Vector3d::Constant(height), kOrange);
  }
}

}  // namespace

std::string FormatPointsPly(std::span<const ColouredPoint> points) {
  PlyWriter file;
  for (const ColouredPoint& point : points) {
    file.AddPoint(point.position, point.colour);
  }
  return file.PointFile();
}

std::string FormatScenePly(const ExportModel& model, ObjectShape shape) {
  PlyWriter file;
  for (const ColouredPoint& point : model.points) {
    file.AddPoint(point.position, point.colour);
  }
  AddPyramids(model, file);
  const TriangleMesh mesh = MeshOf(shape);
  for (const PlacedObject& placed : PlaceObjects(model.scene, shape)) {
    file.AddMesh(mesh, placed.world_from_shape, placed.half_extents,
                 ColourOfClass(placed.object->label));
  }
  return file.MeshFile();
}

std::string FormatMeshPly(const Mesh& mesh) {
  ByteWriter vertices;
  ByteWriter faces;
  uint32_t count = 0;
  size_t triangles = 0;
  const auto add = [&](const SurfaceMesh& surface, int32_t object) {
    for (size_t i = 0; i < surface.positions.size(); ++i) {
      vertices.PutMatrix(surface.positions[i]);
      for (const uint8_t channel : surface.colours[i]) {
        vertices.Put(channel);
      }
      vertices.Put(object);
    }
    for (const TriangleMesh::Triangle& triangle : surface.triangles) {
      faces.Put(uint8_t{3});
      for (const uint32_t corner : triangle) {
        faces.Put(static_cast<int32_t>(count + corner));
      }
    }
    count += static_cast<uint32_t>(surface.positions.size());
    triangles += surface.triangles.size();
  };
  add(mesh.scene, -1);
  for (const ObjectSurface& object : mesh.objects) {
    add(object.surface, static_cast<int32_t>(object.id.value));
  }
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
             "property float x\nproperty float y\nproperty float z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\n"
             "property int object\nelement face {}\n"
             "property list uchar int vertex_indices\nend_header\n",
             count, triangles) +
         vertices.bytes() + faces.bytes();
}

}  // namespace hullslam

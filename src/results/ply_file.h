// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "files/bytes.h"
#include "hullslam/geometry/rigid3.h"
#include "report/object_results.h"
#include "results/unit_mesh.h"

namespace hullslam {

// The colour of the centres of keyframes in map.ply.
inline constexpr std::array<uint8_t, 3> kKeyframeColour = {255, 128, 0};

// The vertices of a PLY file of FormatMapPly() (results/ply_file.h).
struct PlyPoints {
  std::vector<Eigen::Vector3f> positions;       // m
  std::vector<std::array<uint8_t, 3>> colours;  // red, green, blue; one per position
  size_t left_out = 0;  // vertices that are not finite or more than 1e6 m from the origin
};

// Reads the vertices of a binary little-endian PLY file with the properties `float x y z, uchar red
// green blue`. Throws InputError with the name of the file if it has another format or is cut off.
PlyPoints ReadPlyPoints(const std::filesystem::path& path);

// The landmarks of map.ply: all vertices but the centres of the keyframes, which come last and have
// a colour of their own. Throws as above.
PlyPoints ReadMapLandmarks(const std::filesystem::path& path);

// A surface of triangles whose vertices have colours.
struct PlySurface {
  std::vector<Eigen::Vector3f> positions;         // m
  std::vector<Colour> colours;                    // one per position
  std::vector<TriangleMesh::Triangle> triangles;  // indices into `positions`
};

// Reads the surface of the scene from a file of FormatMeshPly() (exports/single_files.h). Those of
// the objects, which show the same places again, are left out. Throws InputError with the name of
// the file if it has another format or is cut off, if a position is not finite or more than 1e6 m
// from the origin, or if a triangle has a corner that is no vertex.
PlySurface ReadPlySurface(const std::filesystem::path& path);

// Makes binary little-endian PLY files whose vertices have `float x y z, uchar red green blue`, in
// the world frame. Faces are `uchar 3, int a b c`.
class PlyWriter {
 public:
  void AddPoint(const Eigen::Vector3d& position, const Colour& colour);
  // A mesh whose coordinates are multiplied by `extents` before it is moved to its pose.
  void AddMesh(const TriangleMesh& mesh, const Rigid3& world_from_mesh,
               const Eigen::Vector3d& extents, const Colour& colour);
  // The file with all points and meshes so far.
  std::string PointFile() const;  // without a list of faces
  std::string MeshFile() const;   // with the list, which may be empty

 private:
  std::string Format(const std::string& more_elements) const;

  ByteWriter vertices_;
  ByteWriter faces_;
  uint32_t vertex_count_ = 0;
  size_t face_count_ = 0;
};

// A binary little-endian PLY with points `float x y z, uchar red green blue`, in metres in the
// world frame: first the landmarks in grey, then the centres of the keyframes in orange.
std::string FormatMapPly(std::span<const Eigen::Vector3d> landmarks,
                         std::span<const Eigen::Vector3d> keyframes);

// A binary little-endian PLY with the ellipsoids of the mapped objects as triangles. The vertices
// have the same properties as above; the faces are `uchar 3, int a b c`, with corners in
// anticlockwise order seen from outside. The colour shows the class; a class has the same colour in
// every run.
std::string FormatObjectsPly(std::span<const ObjectResult> objects);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/ply_file.h"

#include <fmt/format.h>

#include <charconv>
#include <string>
#include <string_view>

#include "files/bytes.h"
#include "files/read_file.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

constexpr size_t kMostBytes = 2'000'000'000;
constexpr std::string_view kStart = "ply\nformat binary_little_endian 1.0\nelement vertex ";
constexpr std::string_view kProperties =
    "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar "
    "green\nproperty uchar blue\n";
constexpr std::string_view kEnd = "end_header\n";
constexpr size_t kBytesPerVertex = 15;

[[noreturn]] void Fail(const std::filesystem::path& path, const char* reason) {
  throw InputError(path.string() + ": " + reason);
}

}  // namespace

PlyPoints ReadPlyPoints(const std::filesystem::path& path) {
  const std::string content = ReadFile(path, kMostBytes);
  std::string_view rest = content;
  size_t count = 0;
  bool is_good = rest.starts_with(kStart);
  if (is_good) {
    rest.remove_prefix(kStart.size());
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), count);
    rest.remove_prefix(static_cast<size_t>(end - rest.data()));
    is_good = error == std::errc() && rest.starts_with(kProperties);
  }
  const size_t end = rest.find(kEnd);
  if (!is_good || end == std::string_view::npos) {
    Fail(path,
         "expected a binary little-endian PLY file whose vertices have float x y z and uchar red "
         "green blue");
  }
  rest.remove_prefix(end + kEnd.size());
  if (count > rest.size() / kBytesPerVertex) {
    Fail(path, "is cut off, it has fewer vertices than its header says");
  }
  ByteReader reader(rest, path.string());
  PlyPoints points;
  constexpr float kMost = 1e6f;
  for (size_t i = 0; i < count; ++i) {
    Eigen::Vector3f position;
    for (float& coordinate : position) {
      coordinate = reader.Get<float>();
    }
    std::array<uint8_t, 3> colour{};
    for (uint8_t& channel : colour) {
      channel = reader.Get<uint8_t>();
    }
    if (position.allFinite() && position.cwiseAbs().maxCoeff() <= kMost) {
      points.positions.push_back(position);
      points.colours.push_back(colour);
    } else {
      ++points.left_out;
    }
  }
  return points;
}

PlyPoints ReadMapLandmarks(const std::filesystem::path& path) {
  PlyPoints points = ReadPlyPoints(path);
  while (!points.colours.empty() && points.colours.back() == kKeyframeColour) {
    points.colours.pop_back();
    points.positions.pop_back();
  }
  return points;
}

void PlyWriter::AddPoint(const Eigen::Vector3d& position, const Colour& colour) {
  for (const double coordinate : position) {
    vertices_.Put(static_cast<float>(coordinate));
  }
  for (const uint8_t channel : colour) {
    vertices_.Put(channel);
  }
  ++vertex_count_;
}

void PlyWriter::AddMesh(const TriangleMesh& mesh, const Rigid3& world_from_mesh,
                        const Eigen::Vector3d& extents, const Colour& colour) {
  const uint32_t first = vertex_count_;
  for (const Eigen::Vector3d& corner : mesh.corners) {
    AddPoint(world_from_mesh * corner.cwiseProduct(extents), colour);
  }
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    faces_.Put(uint8_t{3});
    for (const uint32_t corner : triangle) {
      faces_.Put(static_cast<int32_t>(first + corner));
    }
  }
  face_count_ += mesh.triangles.size();
}

std::string PlyWriter::PointFile() const { return Format(""); }

std::string PlyWriter::MeshFile() const {
  return Format(
      fmt::format("element face {}\nproperty list uchar int vertex_indices\n", face_count_));
}

std::string PlyWriter::Format(const std::string& more_elements) const {
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
             "property float x\nproperty float y\nproperty float z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\n{}end_header\n",
             vertex_count_, more_elements) +
         vertices_.bytes() + faces_.bytes();
}

std::string FormatMapPly(std::span<const Eigen::Vector3d> landmarks,
                         std::span<const Eigen::Vector3d> keyframes) {
  constexpr Colour kGrey = {128, 128, 128};
  PlyWriter file;
  for (const Eigen::Vector3d& landmark : landmarks) {
    file.AddPoint(landmark, kGrey);
  }
  for (const Eigen::Vector3d& center : keyframes) {
    file.AddPoint(center, kKeyframeColour);
  }
  return file.PointFile();
}

std::string FormatObjectsPly(std::span<const ObjectResult> objects) {
  const TriangleMesh sphere = UnitSphere();
  PlyWriter file;
  for (const ObjectResult& object : objects) {
    if (object.state == ObjectState::kMapped) {
      file.AddMesh(sphere, object.ellipsoid.world_from_object, object.ellipsoid.half_axes,
                   ColourOfClass(object.label));
    }
  }
  return file.MeshFile();
}

}  // namespace hullslam

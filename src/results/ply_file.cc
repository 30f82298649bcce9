// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
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
constexpr std::string_view kFaces = "property int object\nelement face ";
constexpr std::string_view kCorners = "\nproperty list uchar int vertex_indices\nend_header\n";
constexpr std::string_view kEnd = "end_header\n";
constexpr size_t kBytesPerVertex = 15;
constexpr size_t kBytesPerObject = 4;  // the id of the object of a vertex of a surface
constexpr size_t kBytesPerFace = 13;
constexpr float kMostMetresAway = 1e6f;
constexpr const char* kCutOff = "is cut off, it has fewer vertices than its header says";

// Takes a text from the beginning of `rest`. False if `rest` begins otherwise.
bool TakeText(std::string_view text, std::string_view& rest) {
  const bool is_there = rest.starts_with(text);
  rest.remove_prefix(is_there ? text.size() : 0);
  return is_there;
}

// The same for a number.
bool TakeCount(std::string_view& rest, size_t& count) {
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), count);
  rest.remove_prefix(static_cast<size_t>(end - rest.data()));
  return error == std::errc();
}

Colour ReadPlyColour(ByteReader& reader) {
  Colour colour{};
  for (uint8_t& channel : colour) {
    channel = reader.Get<uint8_t>();
  }
  return colour;
}

[[noreturn]] void Fail(const std::filesystem::path& path, const char* reason) {
  throw InputError(path.string() + ": " + reason);
}

}  // namespace

PlyPoints ReadPlyPoints(const std::filesystem::path& path) {
  const std::string content = ReadFile(path, kMostBytes);
  std::string_view rest = content;
  size_t count = 0;
  const bool is_good =
      TakeText(kStart, rest) && TakeCount(rest, count) && TakeText(kProperties, rest);
  const size_t end = rest.find(kEnd);
  if (!is_good || end == std::string_view::npos) {
    Fail(path,
         "expected a binary little-endian PLY file whose vertices have float x y z and uchar red "
         "green blue");
  }
  rest.remove_prefix(end + kEnd.size());
  if (count > rest.size() / kBytesPerVertex) {
    Fail(path, kCutOff);
  }
  ByteReader reader(rest, path.string());
  PlyPoints points;
  for (size_t i = 0; i < count; ++i) {
    Eigen::Vector3f position;
    for (float& coordinate : position) {
      coordinate = reader.Get<float>();
    }
    const Colour colour = ReadPlyColour(reader);
    if (position.allFinite() && position.cwiseAbs().maxCoeff() <= kMostMetresAway) {
      points.positions.push_back(position);
      points.colours.push_back(colour);
    } else {
      ++points.left_out;
    }
  }
  return points;
}

PlySurface ReadPlySurface(const std::filesystem::path& path) {
  const std::string content = ReadFile(path, kMostBytes);
  std::string_view rest = content;
  size_t vertices = 0;
  size_t faces = 0;
  if (!(TakeText(kStart, rest) && TakeCount(rest, vertices) && TakeText(kProperties, rest) &&
        TakeText(kFaces, rest) && TakeCount(rest, faces) && TakeText(kCorners, rest))) {
    Fail(path, "expected a file of `hullslam mesh --output FILE.ply`");
  }
  if (vertices > rest.size() / (kBytesPerVertex + kBytesPerObject)) {
    Fail(path, kCutOff);
  }
  if (faces > (rest.size() - vertices * (kBytesPerVertex + kBytesPerObject)) / kBytesPerFace) {
    Fail(path, "is cut off, it has fewer faces than its header says");
  }
  ByteReader reader(rest, path.string());
  PlySurface surface;
  for (size_t i = 0; i < vertices; ++i) {
    const auto position = reader.GetMatrix<Eigen::Vector3f>(kMostMetresAway);
    const Colour colour = ReadPlyColour(reader);
    if (reader.Get<int32_t>() == -1 && surface.positions.size() == i) {  // the scene comes first
      surface.positions.push_back(position);
      surface.colours.push_back(colour);
    }
  }
  for (size_t i = 0; i < faces; ++i) {
    reader.Require(reader.Get<uint8_t>() == 3, "has a face that is no triangle");
    TriangleMesh::Triangle triangle{};
    for (uint32_t& corner : triangle) {
      corner = reader.Get<uint32_t>();
      reader.Require(corner < vertices, "has a face with a corner that is no vertex");
    }
    if (std::ranges::max(triangle) < surface.positions.size()) {
      surface.triangles.push_back(triangle);
    }
  }
  reader.ExpectEnd();
  return surface;
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

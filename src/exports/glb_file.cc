// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "exports/single_files.h"
#include "files/bytes.h"

namespace hullslam {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the specification.
constexpr int kFloat = 5126;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kVertices = 34962;
constexpr int kIndices = 34963;
constexpr int kPoints = 0;
constexpr int kLines = 1;
constexpr int kLineStrip = 3;
constexpr size_t kRoot = 0;  // index of the node "map"

// Colours of glTF are linear, colours of images are sRGB (IEC 61966-2-1).
double Linear(uint8_t channel) {
  const double value = channel / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

Json ToJson(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

Json ToJson(const Eigen::Quaterniond& rotation) {
  const Eigen::Quaterniond q = rotation.normalized();
  return {q.x(), q.y(), q.z(), q.w()};
}

// The JSON and the binary part of a file that is being made.
struct Gltf {
  Json json;
  ByteWriter binary;
};

// Ends the view of the bytes from `begin` on, and adds an accessor of it. Returns its index.
size_t AddAccessor(size_t begin, int target, Json accessor, Gltf& gltf) {
  const size_t end = gltf.binary.bytes().size();
  while (gltf.binary.bytes().size() % 4 != 0) {
    gltf.binary.Put(uint8_t{0});
  }
  gltf.json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", end - begin}, {"target", target}});
  accessor["bufferView"] = gltf.json["bufferViews"].size() - 1;
  gltf.json["accessors"].push_back(std::move(accessor));
  return gltf.json["accessors"].size() - 1;
}

template <typename Vector>
size_t AddPositions(const std::vector<Vector>& positions, Gltf& gltf) {
  const size_t begin = gltf.binary.bytes().size();
  Eigen::AlignedBox3f box;
  for (const Vector& position : positions) {
    const Eigen::Vector3f rounded = position.template cast<float>();
    gltf.binary.PutMatrix(rounded);
    box.extend(rounded);
  }
  return AddAccessor(begin, kVertices,
                     {{"componentType", kFloat},
                      {"count", positions.size()},
                      {"type", "VEC3"},
                      {"min", ToJson(box.min().cast<double>())},
                      {"max", ToJson(box.max().cast<double>())}},
                     gltf);
}

size_t AddColours(std::span<const Colour> colours, Gltf& gltf) {
  constexpr double kMost = 65535.0;
  const size_t begin = gltf.binary.bytes().size();
  for (const Colour& colour : colours) {
    for (const uint8_t channel : colour) {
      gltf.binary.Put(static_cast<uint16_t>(std::lround(kMost * Linear(channel))));
    }
    gltf.binary.Put(static_cast<uint16_t>(kMost));  // opaque
  }
  return AddAccessor(begin, kVertices,
                     {{"componentType", kUnsignedShort},
                      {"normalized", true},
                      {"count", colours.size()},
                      {"type", "VEC4"}},
                     gltf);
}

// The corners of triangles or the ends of edges.
template <typename Shapes>
size_t AddIndices(const Shapes& shapes, Gltf& gltf) {
  const size_t begin = gltf.binary.bytes().size();
  size_t count = 0;
  for (const auto& shape : shapes) {
    for (const uint32_t corner : shape) {
      gltf.binary.Put(corner);
      ++count;
    }
  }
  return AddAccessor(begin, kIndices,
                     {{"componentType", kUnsignedInt}, {"count", count}, {"type", "SCALAR"}}, gltf);
}

size_t AddMaterial(const std::string& name, const Colour& colour, double opacity, Gltf& gltf) {
  gltf.json["materials"].push_back(
      {{"name", name},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {Linear(colour[0]), Linear(colour[1]), Linear(colour[2]), opacity}},
         {"metallicFactor", 0.0},
         {"roughnessFactor", 1.0}}}});
  if (opacity < 1.0) {
    gltf.json["materials"].back()["alphaMode"] = "BLEND";
  }
  return gltf.json["materials"].size() - 1;
}

size_t AddMesh(Json primitive, Gltf& gltf) {
  gltf.json["meshes"].push_back({{"primitives", Json::array({std::move(primitive)})}});
  return gltf.json["meshes"].size() - 1;
}

// Adds a node inside of the node "map".
void AddNode(Json node, Gltf& gltf) {
  gltf.json["nodes"].push_back(std::move(node));
  gltf.json["nodes"][kRoot]["children"].push_back(gltf.json["nodes"].size() - 1);
}

void AddPoints(std::span<const ColouredPoint> points, Gltf& gltf) {
  if (points.empty()) {
    return;
  }
  std::vector<Eigen::Vector3d> positions;
  std::vector<Colour> colours;
  for (const ColouredPoint& point : points) {
    positions.push_back(point.position);
    colours.push_back(point.colour);
  }
  const size_t position = AddPositions(positions, gltf);
  const size_t colour = AddColours(colours, gltf);
  const size_t mesh = AddMesh(
      {{"attributes", {{"POSITION", position}, {"COLOR_0", colour}}}, {"mode", kPoints}}, gltf);
  AddNode({{"name", "points"}, {"mesh", mesh}}, gltf);
}

void AddPath(const Trajectory& trajectory, Gltf& gltf) {
  constexpr Colour kOrange = {255, 128, 0};
  if (trajectory.size() < 2) {
    return;
  }
  std::vector<Eigen::Vector3d> positions;
  for (const StampedPose& pose : trajectory) {
    positions.push_back(pose.world_from_cam.translation);
  }
  const size_t position = AddPositions(positions, gltf);
  const size_t mesh = AddMesh({{"attributes", {{"POSITION", position}}},
                               {"mode", kLineStrip},
                               {"material", AddMaterial("path", kOrange, 1.0, gltf)}},
                              gltf);
  AddNode({{"name", "path"}, {"mesh", mesh}}, gltf);
}

// Cameras of glTF look along -z, and y points up in the image. They have no principal point.
void AddCameras(const ExportModel& model, Gltf& gltf) {
  if (!model.camera) {
    return;
  }
  const PinholeCamera& camera = *model.camera;
  const double half_height = camera.height / (2.0 * camera.fy);
  const double half_width = camera.width / (2.0 * camera.fx);
  const Eigen::Quaterniond turned(0.0, 1.0, 0.0, 0.0);  // half a turn around x
  for (const StampedPose& keyframe : model.keyframes) {
    AddNode({{"name", fmt::format("keyframe {:.6f}", keyframe.timestamp)},
             {"camera", 0},
             {"translation", ToJson(keyframe.world_from_cam.translation)},
             {"rotation", ToJson(keyframe.world_from_cam.rotation * turned)}},
            gltf);
  }
  if (!model.keyframes.empty()) {
    gltf.json["cameras"].push_back({{"type", "perspective"},
                                    {"perspective",
                                     {{"yfov", 2.0 * std::atan(half_height)},
                                      {"aspectRatio", half_width / half_height},
                                      {"znear", 0.01}}}});
  }
}

using CubeEdge = std::array<uint32_t, 2>;  // indices of the corners of the unit cube

std::vector<CubeEdge> CubeEdges() {
  const std::vector<Eigen::Vector3d> corners = UnitCube().corners;
  std::vector<CubeEdge> edges;
  for (uint32_t a = 0; a < corners.size(); ++a) {
    for (uint32_t b = a + 1; b < corners.size(); ++b) {
      if ((corners[a] - corners[b]).squaredNorm() < 5.0) {  // 4: an edge; 8 and 12: diagonals
        edges.push_back({a, b});
      }
    }
  }
  return edges;
}

// Adds the edges of the object's box as a child of the last node, which is the object's. Scales of
// this node would skew a box with a pose of its own, so its corners are in the frame of the node.
void AddBox(const PlacedObject& placed, size_t edges, size_t material, Gltf& gltf) {
  const UprightBox& box = *placed.object->box;
  const Rigid3 shape_from_box = Inverse(placed.world_from_shape) * box.world_from_box;
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector3d& corner : UnitCube().corners) {
    corners.emplace_back((shape_from_box * corner.cwiseProduct(box.half_extents))
                             .cwiseQuotient(placed.half_extents));
  }
  const size_t mesh = AddMesh({{"attributes", {{"POSITION", AddPositions(corners, gltf)}}},
                               {"mode", kLines},
                               {"indices", edges},
                               {"material", material}},
                              gltf);
  Json& nodes = gltf.json["nodes"];
  nodes.back()["children"].push_back(nodes.size());
  nodes.push_back({{"name", placed.object->label + " box"}, {"mesh", mesh}});
}

void AddObjects(const Scene& scene, ObjectShape shape, Gltf& gltf) {
  constexpr double kOpacity = 0.5;
  if (scene.objects.empty()) {
    return;
  }
  const TriangleMesh mesh = MeshOf(shape);
  const size_t corners = AddPositions(mesh.corners, gltf);
  const size_t triangles = AddIndices(mesh.triangles, gltf);
  std::optional<size_t> edges;
  std::map<std::string, size_t> meshes, materials;  // by class
  for (const PlacedObject& placed : PlaceObjects(scene, shape)) {
    const SceneObject& object = *placed.object;
    if (!meshes.contains(object.label)) {
      materials[object.label] =
          AddMaterial(object.label, ColourOfClass(object.label), kOpacity, gltf);
      meshes[object.label] = AddMesh({{"attributes", {{"POSITION", corners}}},
                                      {"indices", triangles},
                                      {"material", materials[object.label]}},
                                     gltf);
    }
    AddNode({{"name", object.label},
             {"mesh", meshes[object.label]},
             {"translation", ToJson(placed.world_from_shape.translation)},
             {"rotation", ToJson(placed.world_from_shape.rotation)},
             {"scale", ToJson(placed.half_extents)},
             {"extras",
              {{"object", object.id.value},
               {"class", object.label},
               {"class_distribution", Json(object.shares)},
               {"half_extents", ToJson(placed.half_extents)},
               {"times_seen", object.observations},
               {"quality", object.quality}}}},
            gltf);
    if (object.box && shape != ObjectShape::kBoxes) {
      edges = edges ? edges : AddIndices(CubeEdges(), gltf);
      AddBox(placed, *edges, materials[object.label], gltf);
    }
  }
}

// The header, the JSON and the binary part, each of a size that four divides.
std::string JoinChunks(const std::string& json, const std::string& binary) {
  constexpr uint32_t kMagic = 0x46546C67;   // "glTF"
  constexpr uint32_t kJson = 0x4E4F534A;    // "JSON"
  constexpr uint32_t kBinary = 0x004E4942;  // "BIN"
  constexpr uint32_t kHeaderBytes = 12;
  constexpr uint32_t kChunkBytes = 8;
  const auto size = [](const std::string& text) { return static_cast<uint32_t>(text.size()); };
  ByteWriter writer;
  writer.Put(kMagic);
  writer.Put(uint32_t{2});
  writer.Put(kHeaderBytes + kChunkBytes + size(json) +
             (binary.empty() ? 0U : kChunkBytes + size(binary)));
  writer.Put(size(json));
  writer.Put(kJson);
  std::string bytes = writer.bytes() + json;
  if (!binary.empty()) {
    ByteWriter header;
    header.Put(size(binary));
    header.Put(kBinary);
    bytes += header.bytes() + binary;
  }
  return bytes;
}

// A file that has only the node "map".
Gltf BeginGltf(const std::optional<Eigen::Vector3d>& up) {
  Gltf gltf;
  gltf.json["asset"] = {{"version", "2.0"}, {"generator", "HullSLAM"}};
  gltf.json["scene"] = 0;
  gltf.json["scenes"][0]["nodes"].push_back(kRoot);
  gltf.json["nodes"].push_back(
      {{"name", "map"},
       {"rotation", ToJson(Eigen::Quaterniond::FromTwoVectors(
                        up.value_or(-Eigen::Vector3d::UnitY()), Eigen::Vector3d::UnitY()))}});
  return gltf;
}

std::string EndGltf(Gltf& gltf) {
  if (!gltf.binary.bytes().empty()) {
    gltf.json["buffers"].push_back({{"byteLength", gltf.binary.bytes().size()}});
  }
  std::string text = gltf.json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return JoinChunks(text, gltf.binary.bytes());
}

// Adds a surface whose material has the colours of the images, which no light changes.
void AddSurface(const SurfaceMesh& surface, Json node, Gltf& gltf) {
  if (surface.triangles.empty()) {
    return;
  }
  const size_t position = AddPositions(surface.positions, gltf);
  const size_t colour = AddColours(surface.colours, gltf);
  const size_t triangles = AddIndices(surface.triangles, gltf);
  node["mesh"] = AddMesh({{"attributes", {{"POSITION", position}, {"COLOR_0", colour}}},
                          {"indices", triangles},
                          {"material", 0}},
                         gltf);
  AddNode(std::move(node), gltf);
}

}  // namespace

std::string FormatGlb(const ExportModel& model, ObjectShape shape) {
  Gltf gltf = BeginGltf(model.scene.up);
  AddPoints(model.points, gltf);
  AddPath(model.trajectory, gltf);
  AddCameras(model, gltf);
  AddObjects(model.scene, shape, gltf);
  return EndGltf(gltf);
}

std::string FormatMeshGlb(const Mesh& mesh) {
  constexpr const char* kUnlit = "KHR_materials_unlit";
  Gltf gltf = BeginGltf(mesh.up);
  gltf.json["extensionsUsed"].push_back(kUnlit);
  gltf.json["materials"].push_back({{"name", "surface"},
                                    {"pbrMetallicRoughness", {{"metallicFactor", 0.0}}},
                                    {"extensions", {{kUnlit, Json::object()}}}});
  AddSurface(mesh.scene, {{"name", "scene"}}, gltf);
  for (const ObjectSurface& object : mesh.objects) {
    AddSurface(object.surface,
               {{"name", fmt::format("{} {}", object.label, object.id.value)},
                {"extras", {{"object", object.id.value}, {"class", object.label}}}},
               gltf);
  }
  return EndGltf(gltf);
}

}  // namespace hullslam

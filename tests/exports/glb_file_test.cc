// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "exports/single_files.h"
#include "files/bytes.h"
#include "support/made_export.h"

namespace hullslam {
namespace {

using Json = nlohmann::json;

// The two parts of a file.
struct ReadGlb {
  Json json;
  std::string binary;

  explicit ReadGlb(const std::string& bytes) {
    ByteReader reader(bytes, "scene.glb");
    EXPECT_EQ(reader.Get<uint32_t>(), 0x46546C67U);
    EXPECT_EQ(reader.Get<uint32_t>(), 2U);
    EXPECT_EQ(reader.Get<uint32_t>(), bytes.size());
    const uint32_t json_size = reader.Get<uint32_t>();
    EXPECT_EQ(json_size % 4, 0U);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    json = Json::parse(bytes.substr(20, json_size));
    if (bytes.size() > 20 + json_size) {
      EXPECT_EQ(bytes.substr(24 + json_size, 4), std::string("BIN\0", 4));
      binary = bytes.substr(28 + json_size);
      EXPECT_EQ(json["buffers"][0]["byteLength"], binary.size());
    }
  }

  const Json& Node(const std::string& name) const {
    for (const Json& node : json["nodes"]) {
      if (node["name"] == name) {
        return node;
      }
    }
    throw std::runtime_error("no node " + name);
  }
};

Eigen::Quaterniond RotationOf(const Json& node) {
  const Json& q = node["rotation"];
  return {q[3].get<double>(), q[0].get<double>(), q[1].get<double>(), q[2].get<double>()};
}

TEST(Glb, HasPointsPathCamerasAndObjects) {
  const ReadGlb glb(FormatGlb(MadeExportModel(), ObjectShape::kEllipsoids));
  EXPECT_EQ(glb.json["asset"]["version"], "2.0");
  EXPECT_EQ(glb.json["nodes"].size(), 8U) << "map, points, path, two cameras, two objects, a box";
  EXPECT_EQ(glb.json["nodes"][0]["children"].size(), 6U);
  const Json& points = glb.json["meshes"][glb.Node("points")["mesh"].get<size_t>()];
  const Json& positions =
      glb.json["accessors"][points["primitives"][0]["attributes"]["POSITION"].get<size_t>()];
  EXPECT_EQ(positions["count"], 2);
  EXPECT_EQ(positions["min"], Json({0.0, -2.0, 2.0}));
  EXPECT_EQ(positions["max"], Json({1.0, 0.5, 3.0}));
  EXPECT_EQ(points["primitives"][0]["mode"], 0);
}

TEST(Glb, ObjectsHaveTheirClassAndShape) {
  const ReadGlb glb(FormatGlb(MadeExportModel(), ObjectShape::kBoxes));
  const Json& cup = glb.Node("cup");
  EXPECT_EQ(cup["scale"], Json({0.5, 0.25, 0.125}));
  EXPECT_EQ(cup["translation"], Json({0.3, 0.1, 2.0}));
  EXPECT_EQ(cup["extras"]["object"], 3);
  EXPECT_EQ(cup["extras"]["class"], "cup");
  EXPECT_EQ(cup["extras"]["times_seen"], 5);
  EXPECT_NE(cup["mesh"], glb.Node("book")["mesh"]) << "each class has a colour of its own";
}

// The corners of the box in the world are those that the node of the object gives them.
TEST(Glb, TheBoxOfAnEllipsoidIsInItsNode) {
  const ExportModel model = MadeExportModel();
  const SceneObject& object = model.scene.objects[0];
  const ReadGlb glb(FormatGlb(model, ObjectShape::kEllipsoids));
  const Json& node = glb.Node("cup");
  EXPECT_EQ(glb.json["nodes"][node["children"][0].get<size_t>()]["name"], "cup box");
  EXPECT_FALSE(glb.Node("book").contains("children")) << "it has no box";
  const Json& primitive =
      glb.json["meshes"][glb.Node("cup box")["mesh"].get<size_t>()]["primitives"][0];
  EXPECT_EQ(primitive["mode"], 1);
  EXPECT_EQ(glb.json["accessors"][primitive["indices"].get<size_t>()]["count"], 24);
  const Json& positions = glb.json["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
  const Json& view = glb.json["bufferViews"][positions["bufferView"].get<size_t>()];
  const std::string bytes = glb.binary.substr(view["byteOffset"].get<size_t>());
  ByteReader reader(bytes, "corners");
  for (int i = 0; i < 8; ++i) {
    const auto corner = reader.GetMatrix<Eigen::Vector3f>(100.0F);
    Eigen::Vector3d scaled;
    for (int axis = 0; axis < 3; ++axis) {
      scaled[axis] = node["scale"][static_cast<size_t>(axis)].get<double>() * corner[axis];
    }
    const Eigen::Vector3d in_box =
        Inverse(object.box->world_from_box) * (object.ellipsoid.world_from_object * scaled);
    EXPECT_LT((in_box.cwiseAbs() - object.box->half_extents).norm(), 1e-6);
  }
  EXPECT_THROW(ReadGlb(FormatGlb(model, ObjectShape::kBoxes)).Node("cup box"), std::runtime_error);
}

TEST(Glb, YPointsUp) {
  ExportModel model = MadeExportModel();
  model.scene.up = Eigen::Vector3d(0.6, 0.0, 0.8);
  const ReadGlb glb(FormatGlb(model, ObjectShape::kBoxes));
  const Eigen::Vector3d up = RotationOf(glb.Node("map")) * *model.scene.up;
  EXPECT_NEAR((up - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-12);
  model.scene.up = std::nullopt;
  const ReadGlb unknown(FormatGlb(model, ObjectShape::kBoxes));
  const Eigen::Vector3d top = RotationOf(unknown.Node("map")) * Eigen::Vector3d(0.0, -1.0, 0.0);
  EXPECT_NEAR((top - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-12);
}

TEST(Glb, CamerasLookAlongMinusZ) {
  ExportModel model = MadeExportModel();
  const Rigid3& pose = model.keyframes[1].world_from_cam;
  const ReadGlb glb(FormatGlb(model, ObjectShape::kBoxes));
  const Json& node = glb.Node("keyframe 102.500000");
  const Eigen::Vector3d forward = RotationOf(node) * Eigen::Vector3d(0.0, 0.0, -1.0);
  EXPECT_NEAR((forward - pose.rotation * Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12);
  const Eigen::Vector3d up = RotationOf(node) * Eigen::Vector3d::UnitY();
  EXPECT_NEAR((up - pose.rotation * Eigen::Vector3d(0.0, -1.0, 0.0)).norm(), 0.0, 1e-12);
  const Json& camera = glb.json["cameras"][0]["perspective"];
  EXPECT_NEAR(camera["yfov"].get<double>(), 2.0 * std::atan(120.0 / 2.0 / 128.0), 1e-12);
}

TEST(Glb, ColoursAreLinear) {
  const ReadGlb glb(FormatGlb(MadeExportModel(), ObjectShape::kBoxes));
  const Json& points = glb.json["meshes"][glb.Node("points")["mesh"].get<size_t>()];
  const Json& colours =
      glb.json["accessors"][points["primitives"][0]["attributes"]["COLOR_0"].get<size_t>()];
  const Json& view = glb.json["bufferViews"][colours["bufferView"].get<size_t>()];
  const std::string bytes = glb.binary.substr(view["byteOffset"].get<size_t>());
  ByteReader reader(bytes, "colours");
  EXPECT_EQ(reader.Get<uint16_t>(), 65535);
  EXPECT_EQ(reader.Get<uint16_t>(), 0);
  // 128 of sRGB is 21.6 % of the light.
  EXPECT_NEAR(reader.Get<uint16_t>() / 65535.0, 0.2159, 1e-3);
  EXPECT_EQ(reader.Get<uint16_t>(), 65535);
}

TEST(Glb, AnEmptyModelHasOnlyTheMap) {
  const ReadGlb glb(FormatGlb(ExportModel(), ObjectShape::kBoxes));
  EXPECT_EQ(glb.json["nodes"].size(), 1U);
  EXPECT_FALSE(glb.json.contains("buffers"));
}

TEST(Glb, ClassesThatAreNoUtf8AreReplaced) {
  ExportModel model = MadeExportModel();
  model.scene.objects[0].label = "cup\xff";
  EXPECT_NO_THROW(ReadGlb(FormatGlb(model, ObjectShape::kBoxes)));
}

Mesh MadeMesh() {
  Mesh mesh;
  mesh.scene = {{{0.0F, 0.0F, 1.0F}, {1.0F, 0.0F, 1.0F}, {0.0F, 1.0F, 1.0F}, {1.0F, 1.0F, 1.0F}},
                {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {9, 9, 9}},
                {{0, 1, 2}, {2, 1, 3}}};
  mesh.objects.push_back({ObjectId(4), "cup", mesh.scene});
  mesh.objects.push_back({ObjectId(5), "book", {}});  // without a surface
  return mesh;
}

TEST(Glb, AMeshHasANodePerObject) {
  const ReadGlb glb(FormatMeshGlb(MadeMesh()));
  EXPECT_EQ(glb.json["nodes"].size(), 3U) << "map, scene, cup";
  EXPECT_EQ(glb.Node("cup 4")["extras"]["object"], 4);
  EXPECT_EQ(glb.Node("cup 4")["extras"]["class"], "cup");
  const Json& primitive =
      glb.json["meshes"][glb.Node("scene")["mesh"].get<size_t>()]["primitives"][0];
  const Json& indices = glb.json["accessors"][primitive["indices"].get<size_t>()];
  EXPECT_EQ(indices["count"], 6);
  const Json& view = glb.json["bufferViews"][indices["bufferView"].get<size_t>()];
  const std::string bytes = glb.binary.substr(view["byteOffset"].get<size_t>());
  ByteReader reader(bytes, "indices");
  for (const uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U}) {
    EXPECT_EQ(reader.Get<uint32_t>(), corner);
  }
  const size_t colours = primitive["attributes"]["COLOR_0"].get<size_t>();
  EXPECT_EQ(glb.json["accessors"][colours]["count"], 4);
  EXPECT_TRUE(glb.json["materials"][0]["extensions"].contains("KHR_materials_unlit"));
}

}  // namespace
}  // namespace hullslam

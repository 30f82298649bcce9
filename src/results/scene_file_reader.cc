// SPDX-License-Identifier: GPL-3.0-or-later
// The reader of results/scene_file.h.
#include <algorithm>
#include <cmath>
#include <map>

#include "files/json_file.h"
#include "files/plausible.h"
#include "results/scene_file.h"
#include "util/text.h"

namespace hullslam {
namespace {

Eigen::Vector3d ReadPosition(const JsonNode& node) {
  const std::vector<double> values = node.Numbers(3);
  const Eigen::Vector3d position(values[0], values[1], values[2]);
  if (position.cwiseAbs().maxCoeff() > kMostMetres) {
    node.Fail("three plausible lengths");
  }
  return position;
}

Eigen::Quaterniond ReadRotation(const JsonNode& node) {
  constexpr double kTolerance = 1e-3;
  const std::vector<double> values = node.Numbers(4);
  const Eigen::Quaterniond rotation(values[3], values[0], values[1], values[2]);
  if (!(std::abs(rotation.norm() - 1.0) <= kTolerance)) {
    node.Fail("a quaternion [x, y, z, w] of length 1");
  }
  return rotation.normalized();
}

Eigen::Matrix3d ReadCovariance(const JsonNode& node) {
  const std::vector<JsonNode> rows = node.Elements();
  if (rows.size() != 3) {
    node.Fail("three rows of three numbers");
  }
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 3; ++i) {
    const std::vector<double> row = rows[static_cast<size_t>(i)].Numbers(3);
    matrix.row(i) << row[0], row[1], row[2];
    if (matrix.row(i).cwiseAbs().maxCoeff() > kMostMetres) {
      rows[static_cast<size_t>(i)].Fail("plausible variances");
    }
  }
  return matrix;
}

std::map<std::string, double> ReadShares(const JsonNode& node) {
  std::map<std::string, double> shares;
  for (const auto& [label, share] : node.Members()) {
    shares[Printable(label)] += share.Number(1.0);
  }
  return shares;
}

void ReadSeenSides(const JsonNode& node, UprightBox& box) {
  const std::vector<JsonNode> sides = node.Elements();
  if (sides.size() != box.is_seen.size()) {
    node.Fail("true or false for each of six sides");
  }
  for (size_t i = 0; i < sides.size(); ++i) {
    box.is_seen[i] = sides[i].Flag();
  }
}

// Files of earlier versions do not have these keys.
void ReadAxes(const JsonNode& object, const char* key, bool FreeAxis::*property,
              ShapeCovariance& covariance) {
  if (!object.Has(key)) {
    return;
  }
  for (const JsonNode& name : object.At(key).Elements()) {
    const std::string text = name.Text();
    if (text != "x" && text != "y" && text != "z") {
      name.Fail("x, y or z");
    }
    covariance.axes.at(static_cast<size_t>(text[0] - 'x')).*property = true;
  }
}

SceneObject ReadSceneObject(const JsonNode& node) {
  SceneObject object;
  object.id = ObjectId(node.At("id").Count());
  object.label = node.At("class").Text();
  object.shares = ReadShares(node.At("class_distribution"));
  object.ellipsoid.world_from_object = {ReadRotation(node.At("rotation")),
                                        ReadPosition(node.At("centre"))};
  object.ellipsoid.half_axes = node.At("axes").Lengths();
  if (node.Has("box")) {
    const JsonNode box = node.At("box");
    object.box = UprightBox{{ReadRotation(box.At("rotation")), ReadPosition(box.At("centre"))},
                            box.At("half_extents").Lengths()};
    if (box.Has("sides_seen")) {
      ReadSeenSides(box.At("sides_seen"), *object.box);
    }
  }
  if (node.Has("centre_covariance")) {
    object.covariance = ShapeCovariance{ReadCovariance(node.At("centre_covariance")),
                                        ReadCovariance(node.At("axes_covariance"))};
    ReadAxes(node, "round_axes", &FreeAxis::is_round, *object.covariance);
    ReadAxes(node, "undetermined_axes", &FreeAxis::is_undetermined, *object.covariance);
  }
  object.observations = node.At("times_seen").Count();
  object.first_seen = node.At("first_seen").Number(kMostSeconds);
  object.last_seen = node.At("last_seen").Number(kMostSeconds);
  object.quality = node.At("quality").Number(1.0);
  if (node.Has("vector")) {
    for (const JsonNode& element : node.At("vector").Elements()) {
      object.embedding.push_back(static_cast<float>(element.Number(1.0)));
    }
  }
  return object;
}

ObjectId ReadKnownId(const JsonNode& node, const Scene& scene) {
  const ObjectId id(node.Count());
  if (scene.Find(id) == nullptr) {
    node.Fail("the id of an object of this file");
  }
  return id;
}

Relation ReadRelation(const JsonNode& node, const Scene& scene) {
  Relation relation;
  relation.subject = ReadKnownId(node.At("subject"), scene);
  relation.object = ReadKnownId(node.At("object"), scene);
  const auto kind = ParseRelationKind(node.At("relation").Text());
  if (!kind) {
    node.At("relation").Fail("on, in, beside, in front of, supports, part of or hidden by");
  }
  relation.kind = *kind;
  for (const auto& [name, value] : node.At("evidence").Members()) {
    relation.evidence.emplace_back(Printable(name), value.Number(kMostMetres));
  }
  return relation;
}

Surface ReadSurface(const JsonNode& node, const Scene& scene) {
  Surface surface;
  surface.height = node.At("height").Number(kMostMetres);
  surface.is_lowest = node.At("lowest").Flag();
  for (const JsonNode& id : node.At("objects").Elements()) {
    surface.objects.push_back(ReadKnownId(id, scene));
  }
  return surface;
}

}  // namespace

Scene ReadScene(const std::filesystem::path& path) {
  const nlohmann::json json = ReadJson(path);
  const JsonNode top(path, json);
  if (top.At("version").Count() != kSceneFileVersion) {
    top.At("version").Fail("1, which this version of HullSLAM writes");
  }
  Scene scene;
  if (top.Has("up")) {
    constexpr double kTolerance = 1e-3;
    const Eigen::Vector3d up = ReadPosition(top.At("up"));
    if (!(std::abs(up.norm() - 1.0) <= kTolerance)) {
      top.At("up").Fail("a vector of length 1");
    }
    scene.up = up.normalized();
  }
  scene.up_from = top.At("up_from").Text();
  for (const JsonNode& node : top.At("objects").Elements()) {
    scene.objects.push_back(ReadSceneObject(node));
    const size_t count = scene.objects.size();
    if (count > 1 && !(scene.objects[count - 2].id < scene.objects[count - 1].id)) {
      node.At("id").Fail("a larger id than that of the object before");
    }
  }
  for (const JsonNode& node : top.At("relations").Elements()) {
    scene.relations.push_back(ReadRelation(node, scene));
  }
  for (const JsonNode& node : top.At("surfaces").Elements()) {
    scene.surfaces.push_back(ReadSurface(node, scene));
  }
  return scene;
}

}  // namespace hullslam

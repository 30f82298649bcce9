// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/true_object_file.h"

#include <set>
#include <string>

#include "files/json_file.h"
#include "results/json_text.h"

namespace hullslam {
namespace {

TrueObject ReadTrueObject(const JsonNode& node) {
  TrueObject object;
  object.id = node.At("id").Count();
  object.label = node.At("class").Text();
  object.shape = node.At("shape").Text();
  object.is_round = node.Has("round") && node.At("round").Flag();
  if (node.Has("masks")) {
    object.masks = node.At("masks").Count();
  }
  object.is_dynamic = node.At("dynamic").Flag();
  object.world_from_object = PoseOf(node.At("world_from_object"));
  object.half_extents = node.At("half_extents").Lengths();
  return object;
}

void ReadStatus(const JsonNode& node, TrueObject& object) {
  const JsonNode status = node.At("status");
  const std::string text = status.Text();
  if (text == "unchanged") {
    object.status = TrueObjectStatus::kUnchanged;
  } else if (text == "new") {
    object.status = TrueObjectStatus::kNew;
  } else if (text == "moved") {
    object.status = TrueObjectStatus::kMoved;
    object.former_world_from_object = PoseOf(node.At("former_world_from_object"));
  } else {
    status.Fail("unchanged, moved or new");
  }
}

// Reads an object whose id is not yet in `ids`, and adds the id.
TrueObject ReadNextObject(const JsonNode& node, std::set<uint32_t>& ids) {
  TrueObject object = ReadTrueObject(node);
  if (!ids.insert(object.id).second) {
    node.At("id").Fail("an id that no other object has");
  }
  return object;
}

}  // namespace

TrueScene ReadTrueScene(const std::filesystem::path& path) {
  const nlohmann::json json = ReadJson(path);
  const JsonNode file(path, json);
  TrueScene scene;
  scene.is_rearranged = file.Has("rearranged");
  std::set<uint32_t> ids;
  for (const JsonNode& node : file.At("objects").Elements()) {
    scene.objects.push_back(ReadNextObject(node, ids));
    if (scene.is_rearranged) {
      ReadStatus(node, scene.objects.back());
    }
  }
  if (scene.is_rearranged) {
    for (const JsonNode& node : file.At("gone").Elements()) {
      scene.gone.push_back(ReadNextObject(node, ids));
    }
  }
  return scene;
}

}  // namespace hullslam

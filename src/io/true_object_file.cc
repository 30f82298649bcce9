// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/true_object_file.h"

#include "io/json_file.h"
#include "io/json_node.h"

namespace hullslam {
namespace {

TrueObject ReadTrueObject(const JsonNode& node) {
  TrueObject object;
  object.id = node.At("id").Count();
  object.label = node.At("class").Text();
  object.shape = node.At("shape").Text();
  object.is_dynamic = node.At("dynamic").Flag();
  object.world_from_object = node.At("world_from_object").Pose();
  object.half_extents = node.At("half_extents").Lengths();
  return object;
}

}  // namespace

std::vector<TrueObject> ReadTrueObjects(const std::filesystem::path& path) {
  const nlohmann::json json = ReadJson(path);
  std::vector<TrueObject> objects;
  for (const JsonNode& node : JsonNode(path, json).At("objects").Elements()) {
    objects.push_back(ReadTrueObject(node));
  }
  return objects;
}

}  // namespace hullslam

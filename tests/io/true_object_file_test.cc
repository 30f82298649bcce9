// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/true_object_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

using Json = nlohmann::ordered_json;

// A file as make_synthetic writes it.
Json File() {
  return Json::parse(R"({"generator": "make_synthetic", "scene": "desk", "seed": 1, "frames": 2,
      "objects": [
        {"id": 0, "class": "cup", "class_id": 41, "shape": "ellipsoid", "dynamic": false,
         "world_from_object": [1, 2, 3, 0, 0, 0, 1], "half_extents": [0.1, 0.2, 0.3]},
        {"id": 1, "class": "person", "class_id": 0, "shape": "box", "dynamic": true,
         "world_from_object": [1, 2, 3, 0, 0, 1, 1], "half_extents": [0.2, 0.2, 0.9],
         "poses": [{"timestamp": 1000, "world_from_object": [1, 2, 3, 0, 0, 0, 1]}]}]})");
}

TEST(TrueObjectFile, ReadsTheFilesOfMakeSynthetic) {
  const TemporaryFolder folder;
  const std::vector<TrueObject> objects =
      ReadTrueObjects(folder.Write("groundtruth_objects.json", File().dump()));
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].label, "cup");
  EXPECT_EQ(objects[0].shape, "ellipsoid");
  EXPECT_FALSE(objects[0].is_dynamic);
  EXPECT_EQ(objects[0].world_from_object.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(objects[0].half_extents, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(objects[1].id, 1U);
  EXPECT_TRUE(objects[1].is_dynamic);
  EXPECT_NEAR(objects[1].world_from_object.rotation.norm(), 1.0, 1e-15);
}

TEST(TrueObjectFile, BrokenValuesAreReportedWithTheirPath) {
  const TemporaryFolder folder;
  const auto expect = [&](const char* key, const Json& value, const std::string& part) {
    Json json = File();
    json["objects"][1][key] = value;
    const auto path = folder.Write("truth.json", json.dump());
    ExpectInputError([&] { ReadTrueObjects(path); },
                     {"truth.json: objects[1]." + std::string(key), part});
  };
  expect("id", "x", "an integer");
  expect("class", 3, "a string");
  expect("shape", nullptr, "a string");
  expect("dynamic", 1, "true or false");
  expect("world_from_object", {1, 2, 3}, "qx");
  expect("half_extents", {1, 2, 0}, "> 0");
  expect("half_extents", {1, 2, 1e155}, "up to 1e+08 m");
  expect("half_extents", {1, 2}, "three numbers > 0");
}

TEST(TrueObjectFile, OtherFilesAreRefused) {
  const TemporaryFolder folder;
  ExpectInputError([&] { ReadTrueObjects(folder.Write("a.json", "{}")); },
                   {"a.json: \"objects\" is missing"});
  ExpectInputError([&] { ReadTrueObjects(folder.Write("a.json", R"({"objects": [{}]})")); },
                   {"objects[0]: \"id\" is missing"});
  ExpectInputError([&] { ReadTrueObjects(folder.Write("a.json", "cup 1 2 3")); },
                   {"is no valid JSON"});
  ExpectInputError([&] { ReadTrueObjects(folder.path() / "none.json"); }, {"none.json"});
}

}  // namespace
}  // namespace hullslam

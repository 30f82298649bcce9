// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/true_object_file.h"

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

// The same scene after a rearrangement: the cup was moved, a vase is new, and a bowl is gone.
Json RearrangedFile() {
  Json json = File();
  json["rearranged"] = 3;
  Json vase = json["objects"][0];
  vase["id"] = 7;
  vase["class"] = "vase";
  vase["status"] = "new";
  json["objects"][0]["status"] = "moved";
  json["objects"][0]["former_world_from_object"] = {4, 5, 6, 0, 0, 0, 2};
  json["objects"][1]["status"] = "unchanged";
  json["objects"].push_back(vase);
  vase.erase("status");
  vase["id"] = 2;
  vase["class"] = "bowl";
  json["gone"] = Json::array({vase});
  return json;
}

TEST(TrueObjectFile, ReadsTheFilesOfMakeSynthetic) {
  const TemporaryFolder folder;
  const std::vector<TrueObject> objects =
      ReadTrueScene(folder.Write("groundtruth_objects.json", File().dump())).objects;
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
    ExpectInputError([&] { ReadTrueScene(path); },
                     {"truth.json: objects[1]." + std::string(key), part});
  };
  expect("id", "x", "an integer");
  expect("class", 3, "a string");
  expect("shape", nullptr, "a string");
  expect("dynamic", 1, "true or false");
  expect("round", 1, "true or false");
  expect("masks", -1, "an integer");
  expect("world_from_object", {1, 2, 3}, "qx");
  expect("half_extents", {1, 2, 0}, "> 0");
  expect("half_extents", {1, 2, 1e155}, "up to 1e+08 m");
  expect("half_extents", {1, 2}, "three numbers > 0");
}

TEST(TrueObjectFile, ReadsRearrangedScenes) {
  const TemporaryFolder folder;
  const auto path = folder.Write("truth.json", RearrangedFile().dump());
  const TrueScene scene = ReadTrueScene(path);
  EXPECT_TRUE(scene.is_rearranged);
  ASSERT_EQ(scene.objects.size(), 3U);
  EXPECT_EQ(scene.objects[0].status, TrueObjectStatus::kMoved);
  ASSERT_TRUE(scene.objects[0].former_world_from_object.has_value());
  EXPECT_EQ(scene.objects[0].former_world_from_object->translation, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(scene.objects[0].former_world_from_object->rotation.w(), 1.0);
  EXPECT_EQ(scene.objects[1].status, TrueObjectStatus::kUnchanged);
  EXPECT_FALSE(scene.objects[1].former_world_from_object.has_value());
  EXPECT_EQ(scene.objects[2].status, TrueObjectStatus::kNew);
  ASSERT_EQ(scene.gone.size(), 1U);
  EXPECT_EQ(scene.gone[0].id, 2U);
  EXPECT_EQ(scene.gone[0].label, "bowl");
  EXPECT_EQ(ReadTrueScene(path).objects.size(), 3U);
  const TrueScene original = ReadTrueScene(folder.Write("before.json", File().dump()));
  EXPECT_FALSE(original.is_rearranged);
  EXPECT_FALSE(original.objects[0].status.has_value());
  EXPECT_TRUE(original.gone.empty());
}

TEST(TrueObjectFile, BrokenRearrangementsAreReportedWithTheirPath) {
  const TemporaryFolder folder;
  const auto expect = [&](const auto& damage, const std::string& path_in_file,
                          const std::string& part) {
    Json json = RearrangedFile();
    damage(json);
    const auto path = folder.Write("truth.json", json.dump());
    ExpectInputError([&] { ReadTrueScene(path); }, {"truth.json: " + path_in_file, part});
  };
  expect([](Json& json) { json["objects"][1].erase("status"); }, "objects[1]", "\"status\"");
  expect([](Json& json) { json["objects"][1]["status"] = "lost"; }, "objects[1].status",
         "unchanged, moved or new");
  expect([](Json& json) { json["objects"][1]["status"] = 2; }, "objects[1].status", "a string");
  expect([](Json& json) { json["objects"][0].erase("former_world_from_object"); }, "objects[0]",
         "\"former_world_from_object\" is missing");
  expect(
      [](Json& json) {
        json["objects"][0]["former_world_from_object"] = {1, 2};
      },
      "objects[0].former_world_from_object", "qx");
  expect([](Json& json) { json.erase("gone"); }, "\"gone\"", "is missing");
  expect([](Json& json) { json["gone"] = 3; }, "gone", "array");
  expect([](Json& json) { json["gone"][0].erase("class"); }, "gone[0]", "\"class\" is missing");
  expect([](Json& json) { json["gone"][0]["id"] = 0; }, "gone[0].id", "no other object");
  expect([](Json& json) { json["objects"][2]["id"] = 1; }, "objects[2].id", "no other object");
}

TEST(TrueObjectFile, OtherFilesAreRefused) {
  const TemporaryFolder folder;
  ExpectInputError([&] { ReadTrueScene(folder.Write("a.json", "{}")); },
                   {"a.json: \"objects\" is missing"});
  ExpectInputError([&] { ReadTrueScene(folder.Write("a.json", R"({"objects": [{}]})")); },
                   {"objects[0]: \"id\" is missing"});
  ExpectInputError([&] { ReadTrueScene(folder.Write("a.json", "cup 1 2 3")); },
                   {"is no valid JSON"});
  ExpectInputError([&] { ReadTrueScene(folder.path() / "none.json"); }, {"none.json"});
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/scene_file.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "hullslam/util/check.h"
#include "scene/made_scene.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

using Json = nlohmann::ordered_json;

Scene MakeFileScene() {
  Scene scene = MakeQueryScene();
  scene.objects[0].box =
      UprightBox{scene.objects[0].ellipsoid.world_from_object, Eigen::Vector3d(0.05, 0.05, 0.05)};
  scene.objects[0].covariance =
      ShapeCovariance{1e-4 * Eigen::Matrix3d::Identity(), 1e-6 * Eigen::Matrix3d::Identity()};
  scene.objects[0].box->is_seen = {true, true, false, true, false, true};
  scene.objects[0].covariance->axes[2].is_round = true;
  scene.objects[0].covariance->axes[0].is_undetermined = true;
  scene.objects[0].observations = 7;
  scene.objects[0].first_seen = 1000.25;
  scene.objects[0].last_seen = 1002.5;
  scene.objects[0].quality = 0.75;
  scene.objects[0].embedding = {0.6f, -0.8f};
  return scene;
}

TEST(SceneFile, HasTheKeysOfTheFormat) {
  const Json json = Json::parse(FormatScene(MakeFileScene()));
  EXPECT_EQ(json["version"], 1);
  EXPECT_EQ(json["up"], Json({0.0, 0.0, 1.0}));
  EXPECT_EQ(json["up_from"], "ground truth");
  const Json& cup = json["objects"][0];
  EXPECT_EQ(cup["id"], 0);
  EXPECT_EQ(cup["class_distribution"]["cup"], 1.0);
  EXPECT_EQ(cup["centre"], Json({0.0, 0.0, 0.1}));
  EXPECT_EQ(cup["axes"], Json({0.05, 0.05, 0.05}));
  EXPECT_EQ(cup["box"]["half_extents"], Json({0.05, 0.05, 0.05}));
  EXPECT_EQ(cup["box"]["sides_seen"], Json({true, true, false, true, false, true}));
  EXPECT_EQ(cup["round_axes"], Json::array({"z"}));
  EXPECT_EQ(cup["undetermined_axes"], Json::array({"x"}));
  EXPECT_TRUE(json["objects"][1]["round_axes"].is_null());
  EXPECT_EQ(cup["centre_covariance"][0][0], 1e-4);
  EXPECT_EQ(cup["times_seen"], 7);
  EXPECT_TRUE(json["objects"][1]["box"].is_null());
  EXPECT_NEAR(cup["vector"][1].get<double>(), -0.8, 1e-6);
  EXPECT_FALSE(json["objects"][1].contains("vector"));
  EXPECT_EQ(json["relations"][0]["relation"], "on");
  EXPECT_EQ(json["relations"][0]["evidence"]["gap"], 0.001);
  EXPECT_EQ(json["surfaces"][0]["lowest"], true);
  EXPECT_TRUE(json["places"].empty());
}

TEST(SceneFile, IsReadBackToTheSameBytes) {
  const TemporaryFolder folder;
  const std::string text = FormatScene(MakeFileScene());
  EXPECT_EQ(FormatScene(ReadScene(folder.Write("scene.json", text))), text);
  Scene empty;
  empty.up_from = "unknown";
  const std::string short_text = FormatScene(empty);
  EXPECT_EQ(FormatScene(ReadScene(folder.Write("scene.json", short_text))), short_text);
}

TEST(SceneFile, RefusesBrokenFilesWithTheKey) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::function<void(Json&)>& change,
                          const std::vector<std::string>& parts) {
    Json json = Json::parse(FormatScene(MakeFileScene()));
    change(json);
    const auto path = folder.Write("scene.json", json.dump());
    std::vector<std::string> expected = parts;
    expected.push_back(path.string());
    ExpectInputError([&] { ReadScene(path); }, expected);
  };
  expect([](Json& json) { json["version"] = 9; }, {"version is 9"});
  expect([](Json& json) { json.erase("relations"); }, {"relations"});
  expect([](Json& json) { json["up"] = {0.0, 0.0, 2.0}; }, {"up"});
  expect([](Json& json) { json["objects"][1]["id"] = 0; }, {"objects[1].id"});
  expect([](Json& json) { json["objects"][0]["centre"][1] = nullptr; }, {"objects[0].centre"});
  expect([](Json& json) { json["objects"][0]["rotation"] = {0, 0, 0, 0}; }, {"rotation"});
  expect([](Json& json) { json["objects"][0]["axes"] = {0.1, -0.1, 0.1}; }, {"axes"});
  expect([](Json& json) { json["objects"][0]["vector"][1] = "x"; }, {"objects[0].vector[1]"});
  expect([](Json& json) { json["objects"][0]["round_axes"] = {"w"}; }, {"round_axes[0]"});
  expect([](Json& json) { json["objects"][0]["box"]["sides_seen"].erase(0); }, {"sides_seen"});
  expect([](Json& json) { json["relations"][0]["object"] = 77; }, {"relations[0].object"});
  expect([](Json& json) { json["relations"][0]["relation"] = "above"; }, {"above"});
  expect([](Json& json) { json["surfaces"][0]["objects"][0] = 77; }, {"surfaces[0].objects"});
  const auto half = folder.Write("scene.json", FormatScene(MakeFileScene()).substr(0, 300));
  ExpectInputError([&] { ReadScene(half); }, {half.string()});
}

TEST(SceneFile, EscapesLabels) {
  Scene scene = MakeFileScene();
  scene.objects[0].label = "<b>\"x\"\n\xF0\x9F\x98\x80\xff";
  scene.objects[0].shares = {{scene.objects[0].label, 1.0}};
  const Json json = Json::parse(FormatScene(scene));
  EXPECT_EQ(json["objects"][0]["class"], "<b>\"x\"\n\xF0\x9F\x98\x80\xEF\xBF\xBD");
}

TEST(SceneFile, ThrowsForNumbersThatAreNotFinite) {
  Scene scene = MakeFileScene();
  scene.objects[0].ellipsoid.half_axes.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FormatScene(scene), CheckError);
}

}  // namespace
}  // namespace hullslam

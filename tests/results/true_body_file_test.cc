// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/true_body_file.h"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hullslam/util/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::ordered_json;
using Round = std::array<bool, 3>;

Json List() {
  return Json::parse(R"({"objects": [
      {"id": 4, "class": "book", "kind": "box", "world_from_object": [1, 2, 3, 0, 0, 0.71, 0.71],
       "half_axes": [0.1, 0.1, 0.02], "seen": false},
      {"id": 7, "class": "cup", "kind": "cylinder", "world_from_object": [0, 0, 0, 0, 0, 0, 1],
       "half_axes": [0.05, 0.05, 0.1]},
      {"id": 8, "class": "ball", "kind": "ellipsoid", "world_from_object": [0, 0, 0, 0, 0, 0, 1],
       "half_axes": [0.1, 0.1, 0.1]},
      {"id": 9, "class": "vase", "kind": "box", "world_from_object": [0, 0, 0, 0, 0, 0, 1],
       "half_axes": [0.1, 0.1, 0.1], "symmetry": ["flip", "round about axis y"]}]})");
}

TEST(TrueBodyFile, ReadsAListOfBodies) {
  const TemporaryFolder folder;
  const std::vector<TrueBody> truths = ReadTrueBodies(folder.Write("truth.json", List().dump()));
  ASSERT_EQ(truths.size(), 4U);
  EXPECT_EQ(truths[0].id, 4U);
  EXPECT_EQ(truths[0].label, "book");
  EXPECT_EQ(truths[0].shape, "box");
  EXPECT_EQ(truths[0].body.kind, BodyKind::kBox);
  EXPECT_EQ(truths[0].body.world_from_body.translation, Vector3d(1, 2, 3));
  EXPECT_NEAR(truths[0].body.world_from_body.rotation.z(), std::sqrt(0.5), 1e-12) << "unit length";
  EXPECT_EQ(truths[0].body.half_axes, Vector3d(0.1, 0.1, 0.02));
  EXPECT_FALSE(truths[0].is_counted);
  EXPECT_TRUE(truths[1].is_counted);
  EXPECT_EQ(truths[0].is_round, (Round{false, false, false})) << "a square box is not round";
  EXPECT_EQ(truths[1].is_round, (Round{false, false, true}));
  EXPECT_EQ(truths[2].is_round, (Round{true, true, true}));
  EXPECT_EQ(truths[3].is_round, (Round{false, true, false}));
}

TEST(TrueBodyFile, BadValuesOfAListAreNamed) {
  const TemporaryFolder folder;
  const auto expect = [&](const char* key, const Json& value, const std::string& part) {
    Json json = List();
    json["objects"][1][key] = value;
    const auto path = folder.Write("truth.json", json.dump());
    ExpectInputError([&] { ReadTrueBodies(path); },
                     {"truth.json: objects[1]." + std::string(key), part});
  };
  expect("id", 4, "an id that no other object has");
  expect("id", -1, "an integer");
  expect("class", nullptr, "a string");
  expect("kind", "cone", "box, cylinder or ellipsoid");
  expect("half_axes", {0.1, 0.0, 0.1}, "> 0");
  expect("half_axes", {0.1, -0.1, 0.1}, "> 0");
  expect("half_axes", {0.1, 0.1}, "three numbers");
  expect("world_from_object", {0, 0, 0, 0, 0, 0, 2}, "a quaternion of length 1");
  expect("world_from_object", {0, 0, 0, 0, 0, 0, 0}, "a quaternion of length 1");
  expect("world_from_object", {0, 0, 1e9, 0, 0, 0, 1}, "a position");
  expect("world_from_object", {0, 0, 0, 0, 0, 0, nullptr}, "qx, qy, qz, qw");
  expect("symmetry", {"twofold"}, "flip");
  expect("symmetry", {"round about axis w"}, "flip");
  expect("symmetry", "flip", "an array");
  expect("seen", 1, "true or false");
  expect("simmetry", {"flip"}, "no such key; the keys are id, class");
  Json json = List();
  json["objects"][2].erase("kind");
  const auto path = folder.Write("truth.json", json.dump());
  ExpectInputError([&] { ReadTrueBodies(path); }, {"objects[2]: \"kind\" is missing"});
}

TEST(TrueBodyFile, OtherAndEmptyFilesAreRefused) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& text, const std::string& part) {
    const auto path = folder.Write("a.json", text);
    ExpectInputError([&] { ReadTrueBodies(path); }, {"a.json", part});
  };
  expect("[]", "an object");
  expect("{}", "\"objects\"");
  expect(R"({"things": []})", "\"objects\"");
  expect(R"({"objects": []})", "has no object that stands still");
  expect(R"({"objects": {}})", "an array");
  expect(R"({"objects": [NaN]})", "is no valid JSON");
  ExpectInputError([&] { ReadTrueBodies(folder.path() / "none.json"); }, {"none.json"});
}

TEST(TrueBodyFile, ReadsWhatMakeSyntheticWrites) {
  const TemporaryFolder folder;
  const auto object = [](int id, const char* shape, bool is_round) {
    return Json{{"id", id},
                {"class", "thing"},
                {"shape", shape},
                {"round", is_round},
                {"dynamic", id == 3},
                {"world_from_object", {1, 2, 3, 0, 0, 0, 1}},
                {"half_extents", {0.1, 0.1, 0.3}},
                {"masks", 10 * id}};
  };
  const Json json = {{"objects",
                      {object(0, "ellipsoid", true), object(1, "superquadric", true),
                       object(2, "compound", false), object(3, "box", false)}}};
  const std::vector<TrueBody> truths =
      ReadTrueBodies(folder.Write("groundtruth_objects.json", json.dump()));
  ASSERT_EQ(truths.size(), 3U) << "what moves is left out";
  EXPECT_EQ(truths[0].body.kind, BodyKind::kEllipsoid);
  EXPECT_EQ(truths[0].is_round, (Round{false, false, true}));
  EXPECT_EQ(truths[1].body.kind, BodyKind::kCylinder);
  EXPECT_EQ(truths[1].shape, "cylinder");
  EXPECT_EQ(truths[1].is_round, (Round{false, false, true}));
  EXPECT_EQ(truths[2].body.kind, BodyKind::kBox);
  EXPECT_EQ(truths[2].shape, "compound");
  EXPECT_EQ(truths[2].masks, 20U);
}

constexpr const char* kCup =
    "#class tx ty tz qx qy qz qw a1 a2 a3\n41 1 2 3 0 0 0.70710678 0.70710678 0.1 0.2 0.3\n"
    "#stamp x y h w\n0.1 10 20 30 40\n0.2 11 21 31 41\n";

TEST(TrueBodyFile, ReadsAFolderOfCubeDiorama) {
  const TemporaryFolder folder;
  folder.Write("obj_offline/0.txt", kCup);
  folder.Write("obj_offline/10.txt", "# corners\n73 0 0 1 0 0 1 0 -0.1 -0.2 0 0.3 0.2 0.05\n");
  folder.Write("obj_offline/notes.md", "not read");
  const std::vector<TrueBody> truths = ReadTrueBodies(folder.path() / "obj_offline");
  ASSERT_EQ(truths.size(), 2U);
  EXPECT_EQ(truths[0].id, 0U);
  EXPECT_EQ(truths[0].label, "41");
  EXPECT_EQ(truths[0].masks, 2U);
  EXPECT_EQ(truths[0].body.kind, BodyKind::kBox);
  EXPECT_EQ(truths[0].body.half_axes, Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(truths[0].body.world_from_body.translation, Vector3d(1, 2, 3));
  EXPECT_TRUE((truths[0].body.world_from_body.rotation * Vector3d::UnitX())
                  .isApprox(Vector3d::UnitY(), 1e-7));
  EXPECT_EQ(truths[1].id, 10U);
  EXPECT_EQ(truths[1].masks, 0U);
  EXPECT_TRUE(truths[1].body.half_axes.isApprox(Vector3d(0.2, 0.2, 0.025), 1e-12));
  // Half a turn about z: the middle of the corners, (0.1, 0, 0.025), is at -x.
  EXPECT_TRUE(truths[1].body.world_from_body.translation.isApprox(Vector3d(-0.1, 0, 1.025), 1e-12));
}

TEST(TrueBodyFile, BadFilesOfCubeDioramaAreNamed) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& text, const std::vector<std::string>& parts) {
    folder.Write("obj/3.txt", text);
    ExpectInputError([&] { ReadTrueBodies(folder.path() / "obj"); }, parts);
  };
  const auto with = [](const std::string& old, const std::string& fresh) {
    std::string text = kCup;
    return text.replace(text.find(old), old.size(), fresh);
  };
  EXPECT_THROW(ReadTrueBodies(folder.path()), InputError) << "no file with a number";
  expect("", {"3.txt"});
  expect("# only a comment\n", {"3.txt: has no object"});
  expect(with(" 0.3\n", "\n"), {"3.txt:2", "10 columns", "three half axes"});
  expect(with("0.1 0.2", "0 0.2"), {"3.txt:2", "0 or negative"});
  expect(with("0.1 0.2", "-0.1 0.2"), {"3.txt:2", "0 or negative"});
  expect("41 0 0 0 0 0 0 1 0.1 0.1 0.1 -0.1 0.2 0.2\n", {"3.txt:1", "lower corner first"});
  expect(with("41 1", "cup 1"), {"3.txt:2", "the class is 'cup'"});
  expect(with("0.70710678 0.70710678", "0.7 0.1"), {"3.txt:2", "length"});
  expect(with(" 2 3 ", " nan 3 "), {"3.txt:2", "position"});
  expect(with(" 2 3 ", " 1e9 3 "), {"3.txt:2", "position"});
  expect(with("30 40\n", "30\n"), {"3.txt:4", "4 columns", "stamp x y height width"});
  expect(with("30 40\n", "30 x\n"), {"3.txt:4", "box"});
}

// A scene of BOP: two boxes of one model and one of another, in two images. The camera of the
// second image is 100 mm farther back.
class BopScene : public ::testing::Test {
 protected:
  static Json Annotation(int model, const Json& position) {
    return {{"obj_id", model}, {"cam_R_m2c", identity_}, {"cam_t_m2c", position}};
  }

  std::vector<TrueBody> Read() {
    folder_.Write("test/000048/scene_camera.json", cameras_.dump());
    folder_.Write("models/models_info.json", models_.dump());
    return ReadTrueBodies(folder_.Write("test/000048/scene_gt.json", scene_.dump()));
  }

  void ExpectRefusal(const std::vector<std::string>& parts) {
    ExpectInputError([&] { Read(); }, parts);
  }

  inline static const Json identity_ = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  TemporaryFolder folder_;
  Json scene_ = {
      {"1",
       {Annotation(5, {0, 0, 1000}), Annotation(5, {400, 0, 1000}), Annotation(12, {0, 300, 800})}},
      {"2", {Annotation(5, {402, 0, 1100}), Annotation(5, {1, 0, 1100})}},
      {"3", {Annotation(5, {1, 0, 1100})}}};
  Json cameras_ = {{"1", {{"cam_R_w2c", identity_}, {"cam_t_w2c", {0, 0, 0}}}},
                   {"2", {{"cam_R_w2c", identity_}, {"cam_t_w2c", {0, 0, 100}}}},
                   {"3", {{"cam_R_w2c", identity_}, {"cam_t_w2c", {0, 0, 100}}}}};
  Json models_ = {{"5",
                   {{"min_x", -50},
                    {"min_y", -20},
                    {"min_z", 0},
                    {"size_x", 100},
                    {"size_y", 40},
                    {"size_z", 60}}},
                  {"12",
                   {{"min_x", -30},
                    {"min_y", -30},
                    {"min_z", -50},
                    {"size_x", 60},
                    {"size_y", 60},
                    {"size_z", 100},
                    {"symmetries_continuous", {{{"axis", {0, 0, 1}}, {"offset", {0, 0, 0}}}}}}}};
};

TEST_F(BopScene, AnnotationsOfOneBodyAreMergedInTheWorld) {
  const std::vector<TrueBody> truths = Read();
  ASSERT_EQ(truths.size(), 3U);
  EXPECT_EQ(truths[0].label, "obj_000005");
  EXPECT_TRUE(truths[0].body.half_axes.isApprox(Vector3d(0.05, 0.02, 0.03), 1e-12));
  EXPECT_TRUE(truths[0].body.world_from_body.translation.isApprox(Vector3d(0.001, 0, 1.03), 1e-9))
      << "the median of three images, and the centre of the box";
  EXPECT_NEAR(truths[1].body.world_from_body.translation.x(), 0.402, 1e-9);
  EXPECT_EQ(truths[2].label, "obj_000012");
  EXPECT_EQ(truths[2].id, 3U);
  EXPECT_EQ(truths[2].is_round, (Round{false, false, true}));
  EXPECT_TRUE(truths[2].is_counted);
}

TEST_F(BopScene, BodiesThatAreHiddenInAllImagesDoNotCount) {
  const auto share = [](double value) { return Json{{"visib_fract", value}}; };
  Json info = {{"1", {share(0.0), share(0.05), share(0.05)}},
               {"2", {share(0.0), share(0.1)}},
               {"3", {share(0.0)}}};
  folder_.Write("test/000048/scene_gt_info.json", info.dump());
  const std::vector<TrueBody> truths = Read();
  EXPECT_TRUE(truths[0].is_counted);
  EXPECT_FALSE(truths[1].is_counted);
  EXPECT_FALSE(truths[2].is_counted);
  info["2"].erase(0);
  folder_.Write("test/000048/scene_gt_info.json", info.dump());
  ExpectRefusal({"scene_gt_info.json: 2 is", "2 annotations as in scene_gt.json"});
}

TEST_F(BopScene, RotationsThatAreMirroredOrScaledAreRefused) {
  scene_["2"][1]["cam_R_m2c"] = {1, 0, 0, 0, 1, 0, 0, 0, -1};
  ExpectRefusal({"scene_gt.json: 2[1].cam_R_m2c", "a rotation by rows (determinant 1"});
  scene_["2"][1]["cam_R_m2c"] = {1.1, 0, 0, 0, 1.1, 0, 0, 0, 1.1};
  ExpectRefusal({"scene_gt.json: 2[1].cam_R_m2c", "rows of length 1"});
  scene_["2"][1]["cam_R_m2c"] = identity_;
  cameras_["3"]["cam_R_w2c"] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  ExpectRefusal({"scene_camera.json: 3.cam_R_w2c", "a rotation"});
}

TEST_F(BopScene, MissingFilesAndKeysAreNamed) {
  scene_["3"][0]["obj_id"] = 6;
  ExpectRefusal({"scene_gt.json: 3[0].obj_id is 6", "a model of models_info.json"});
  scene_["3"][0]["obj_id"] = 5;
  scene_["3"][0]["cam_t_m2c"] = {0, 0};
  ExpectRefusal({"scene_gt.json: 3[0].cam_t_m2c", "3 finite numbers"});
  scene_["3"][0]["cam_t_m2c"] = {0, 0, 1e13};
  ExpectRefusal({"scene_gt.json: 3[0].cam_t_m2c", "a position"});
  scene_.erase("3");
  cameras_["2"].erase("cam_R_w2c");
  ExpectRefusal({"scene_camera.json: 2: \"cam_R_w2c\" is missing"});
  cameras_.erase("2");
  ExpectRefusal({"scene_camera.json: \"2\" is missing"});
  models_["5"]["size_y"] = 0;
  ExpectRefusal({"models_info.json: 5.size_y", "> 0"});
  std::filesystem::remove(folder_.path() / "models/models_info.json");
  ExpectInputError([&] { ReadTrueBodies(folder_.path() / "test/000048/scene_gt.json"); },
                   {"has no models_info.json", "../../models"});
}

}  // namespace
}  // namespace hullslam

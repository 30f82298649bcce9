// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "results/scene_file.h"
#include "scene/made_scene.h"
#include "support/made_npy.h"
#include "support/rendered_desk.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

using Json = nlohmann::json;

class QueryObjects : public ::testing::Test {
 protected:
  QueryObjects() { folder_.Write("run/scene.json", FormatScene(MakeQueryScene())); }

  ProgramResult Ask(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), folder_.path() / "run");
    return RunProgram("hullslam query", arguments);
  }
  void ExpectRefused(const std::vector<std::string>& arguments,
                     const std::vector<std::string>& parts) const {
    const ProgramResult result = RunProgram("hullslam query", arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_TRUE(result.output.empty());
    EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1) << result.errors;
    for (const std::string& part : parts) {
      EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
    }
  }

  TemporaryFolder folder_;
};

TEST_F(QueryObjects, AnswersWithTheBestObjectFirst) {
  const ProgramResult result = Ask({"cup on the book", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Json answers = Json::parse(result.output)["answers"];
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0]["object"], 0);
  EXPECT_EQ(answers[0]["class"], "cup");
  const ProgramResult text = Ask({"cups", "--most", "1"});
  EXPECT_NE(text.output.find("cup"), std::string::npos);
  EXPECT_EQ(std::count(text.output.begin(), text.output.end(), '\n'), 2);
}

TEST_F(QueryObjects, AnswersWithinADistanceAndLikeAnObject) {
  const ProgramResult within = Ask({"--class", "cup", "--within", "0.2", "--of", "3", "--json"});
  ASSERT_EQ(within.exit_code, 0) << within.errors;
  EXPECT_EQ(Json::parse(within.output)["answers"].size(), 2U);
  const ProgramResult like = Ask({"--like", "0", "--json"});
  EXPECT_EQ(Json::parse(like.output)["answers"][0]["object"], 2);
}

TEST_F(QueryObjects, ExitCodeIs1IfNothingFits) {
  EXPECT_EQ(Ask({"laptop on the book"}).exit_code, 1);
  const std::string classes = folder_.Write("classes.txt", "zebra\nfire hydrant\n");
  EXPECT_EQ(Ask({"zebra", "--classes", classes}).exit_code, 1);
  EXPECT_EQ(Ask({"fire hydrants on the floor", "--classes", classes}).exit_code, 1);
}

// The classes of the network are those beside the masks of the run, if they are still there.
TEST_F(QueryObjects, AClassThatOnlyTheNetworkKnowsIsThereNot) {
  EXPECT_EQ(Ask({"is there a giraffe?"}).exit_code, 1);
  EXPECT_EQ(Ask({"--class", "giraffe"}).exit_code, 1);
  EXPECT_EQ(Ask({"is there a cup on the book?"}).exit_code, 0);
  EXPECT_EQ(Ask({"gear wheel"}).exit_code, 2);
  folder_.Write("masks/classes.txt", "gear wheel\ncup\n");
  folder_.Write("run/summary.json",
                R"({"trajectory": {"alignment": "se3"}, "map": {"keyframes": 1, "landmarks": 1},
                   "provenance": {"masks": "masks"}})");
  EXPECT_EQ(Ask({"where are gear wheels"}).exit_code, 1);
  EXPECT_EQ(Ask({"is there a giraffe?"}).exit_code, 2);
}

TEST_F(QueryObjects, RefusesBadQuestionsAndInput) {
  const std::string run = folder_.path() / "run";
  ExpectRefused({run, "unicorn"}, {"'unicorn'", "laptop"});
  EXPECT_EQ(RunProgram("hullslam query", {run, "zebra"}).exit_code, 1) << "known, but not there";
  ExpectRefused({run}, {"QUESTION"});
  ExpectRefused({run, "cup", "--like", "0"}, {"expected one of"});
  ExpectRefused({run, "--within", "1"}, {"--of"});
  ExpectRefused({run, "--within", "nan", "--of", "3"}, {"--within", "nan"});
  ExpectRefused({run, "--like", "77"}, {"object 77"});
  ExpectRefused({run, "--vector", run + "/scene.json"}, {"scene.json", "is no array"});
  ExpectRefused({run, "--vector", folder_.Write("a.npy", NpyHeader("<f4", "(0,)"))}, {"0 rows"});
  ExpectRefused({run, "cup", "--picture", "cups.gif"}, {"--picture", "'cups.gif'", ".jpg"});
  ExpectRefused({folder_.Write("a.map", ""), "cup", "--picture", "a.png"}, {"is a map"});
  ExpectRefused({folder_.path() / "none", "cup"}, {"none", "No such file"});
  folder_.Write("empty/notes.txt", "");
  ExpectRefused({folder_.path() / "empty", "cup"}, {"scene.json", "--masks"});
  folder_.Write("broken/scene.json", "{\"version\":1,");
  ExpectRefused({folder_.path() / "broken", "cup"}, {"scene.json"});
  ExpectRefused({folder_.Write("wrong.map", "no map"), "cup"}, {"wrong.map"});
}

constexpr size_t kClasses = 80;  // of COCO

// The bytes of numpy.save() for vectors that have 1 at the place of their class.
std::string NpyOfClasses(const std::vector<size_t>& classes) {
  std::vector<float> values(classes.size() * kClasses);
  for (size_t i = 0; i < classes.size(); ++i) {
    values[i * kClasses + classes[i]] = 1.0f;
  }
  std::string bytes(values.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return NpyHeader("<f4", "(" + std::to_string(classes.size()) + ", 80)") + bytes;
}

// A vector for each mask, which tells only its class.
void WriteVectors(const std::filesystem::path& masks) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(masks)) {
    if (entry.path().extension() == ".txt" && entry.path().stem() != "classes") {
      files.push_back(entry.path());
    }
  }
  for (std::filesystem::path file : files) {
    std::ifstream in(file);
    std::vector<size_t> classes;
    for (std::string line; std::getline(in, line);) {
      classes.push_back(std::stoul(line));
    }
    std::ofstream(file.replace_extension(".npy"), std::ios::binary) << NpyOfClasses(classes);
  }
}

TEST(QueryObjectsOfARun, KnowsWhatStandsOnTheTable) {
  const RenderedDesk desk(60);
  WriteVectors(desk.path() / "masks");
  const TemporaryFolder folder;
  const std::string run = folder.path() / "run";
  const std::string map = folder.path() / "desk.map";
  const ProgramResult made =
      RunProgram("rgbd_tum", {desk.path(), "--masks", desk.path() / "masks", "--output", run,
                              "--save-map", map, "--quiet"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  const ProgramResult of_run =
      RunProgram("hullslam query", {run, "keyboard on a surface", "--json"});
  ASSERT_EQ(of_run.exit_code, 0) << of_run.errors;
  EXPECT_EQ(Json::parse(of_run.output)["answers"][0]["class"], "keyboard");
  // The map has no ground truth, so the planes of its landmarks tell what is upwards.
  const ProgramResult of_map =
      RunProgram("hullslam query", {map, "keyboard on a surface", "--json"});
  ASSERT_EQ(of_map.exit_code, 0) << of_map.errors;
  EXPECT_EQ(Json::parse(of_map.output)["answers"][0]["object"],
            Json::parse(of_run.output)["answers"][0]["object"]);

  constexpr size_t kKeyboard = 66;
  const std::string vector = folder.Write("keyboard.npy", NpyOfClasses({kKeyboard}));
  const std::string picture = folder.path() / "answers.jpg";
  for (const std::string& source : {run, map}) {
    std::vector<std::string> question = {source, "--vector", vector, "--json"};
    if (source == run) {
      question.insert(question.end(), {"--picture", picture});
    }
    const ProgramResult by_vector = RunProgram("hullslam query", question);
    ASSERT_EQ(by_vector.exit_code, 0) << by_vector.errors;
    const Json best = Json::parse(by_vector.output)["answers"][0];
    EXPECT_EQ(best["class"], "keyboard");
    EXPECT_GT(best["score"], 0.9);
  }
  EXPECT_FALSE(cv::imread(picture).empty());
}

}  // namespace
}  // namespace hullslam

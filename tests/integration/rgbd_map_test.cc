// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of rgbd_tum that save and load maps.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "hullslam/map_files/map_file.h"
#include "support/file_size_limit.h"
#include "support/plane_sequence.h"
#include "support/run_program.h"
#include "support/running_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;
using Json = nlohmann::json;

class RgbdMap : public ::testing::Test {
 protected:
  ProgramResult Run(const Arguments& more) const {
    Arguments arguments = {path_, "--output", output_, "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunProgram("rgbd_tum", arguments);
  }

  void Save(const Arguments& more = {}) const {
    Arguments arguments = {"--save-map", map_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ASSERT_EQ(Run(arguments).exit_code, 0);
  }

  // Expects a refusal before the first frame.
  void ExpectRefusal(const Arguments& arguments, const std::vector<std::string>& parts) const {
    fs::remove_all(output_);
    const ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    for (const std::string& part : parts) {
      EXPECT_NE(result.errors.find(part), std::string::npos)
          << "no '" << part << "' in: " << result.errors;
    }
    EXPECT_FALSE(fs::exists(output_ / "summary.json"));
  }

  Json Summary() const { return Json::parse(ReadFile(output_ / "summary.json")); }

  TemporaryFolder folder_;
  fs::path output_ = folder_.path() / "out";
  fs::path map_ = folder_.path() / "a.map";
  PlaneSequence sequence_;
  std::string path_ = sequence_.path();
};

TEST_F(RgbdMap, SavingAMapChangesNoOtherFile) {
  ASSERT_EQ(Run({}).exit_code, 0);
  const std::string poses = ReadFile(output_ / "trajectory.txt");
  const std::string keyframes = ReadFile(output_ / "keyframes.txt");
  Save();
  EXPECT_EQ(ReadFile(output_ / "trajectory.txt"), poses);
  EXPECT_EQ(ReadFile(output_ / "keyframes.txt"), keyframes);
  const std::string bytes = ReadFile(map_);
  const StoredMap stored = ReadMap(map_);
  EXPECT_EQ(stored.map.keyframes().size(), Summary()["map"]["keyframes"]);
  EXPECT_EQ(stored.map.sessions().size(), 1U);
  EXPECT_EQ(Summary()["map"]["sessions"], 1);
  EXPECT_EQ(stored.map.sessions()[0].name, fs::path(path_).filename().string());
  Save();
  EXPECT_EQ(ReadFile(map_), bytes) << "the same run gives the same bytes";
}

TEST_F(RgbdMap, LocalizationFindsAllFramesAndChangesNothing) {
  Save();
  const std::string bytes = ReadFile(map_);
  ASSERT_EQ(Run({"--load-map", map_, "--save-map", map_, "--localization"}).exit_code, 0);
  EXPECT_EQ(Summary()["trajectory"]["lost"], 0);
  EXPECT_EQ(Summary()["map"]["sessions"], 1);
  EXPECT_EQ(ReadFile(map_), bytes);
}

TEST_F(RgbdMap, ASecondSessionGoesOnWithTheMap) {
  Save();
  const size_t keyframes = Summary()["map"]["keyframes"].get<size_t>();
  ASSERT_EQ(Run({"--load-map", map_}).exit_code, 0);
  EXPECT_EQ(Summary()["trajectory"]["lost"], 0);
  EXPECT_GE(Summary()["map"]["keyframes"].get<size_t>(), keyframes);
}

// Without a vocabulary and without masks no frame is recognised, so a run on a loaded map stays
// lost.
TEST_F(RgbdMap, ARunOnALoadedMapFailsIfNoFrameIsFound) {
  const Arguments no_words = {"--vocabulary", "none"};
  Save(no_words);
  const std::string bytes = ReadFile(map_);
  const std::string name = fs::path(path_).filename().string();
  const std::string head = "# timestamp tx ty tz qx qy qz qw\n";
  for (const bool is_localization : {false, true}) {
    Arguments arguments = {"--load-map", map_, "--save-map", map_, "--set", "run.max_lost_share=1"};
    arguments.insert(arguments.end(), no_words.begin(), no_words.end());
    if (is_localization) {
      arguments.emplace_back("--localization");
    }
    const ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find("no frame was found in this map"), std::string::npos)
        << result.errors;
    EXPECT_EQ(Summary()["trajectory"]["lost"], 12);
    EXPECT_EQ(Summary()["map"]["sessions"], 1);
    EXPECT_EQ(ReadFile(output_ / "trajectory.txt"),
              head + (is_localization ? "# localization: " : "# session 2: ") + name + "\n");
    EXPECT_TRUE(ReadFile(output_ / "keyframes.txt").starts_with(head + "# session 1: " + name));
    EXPECT_EQ(ReadFile(map_), bytes) << "nothing was added to the map";
  }
}

TEST_F(RgbdMap, AMapThatCannotBeSavedHidesNoOtherResults) {
  Save();
  const FileSizeLimit limit(fs::file_size(map_) - 1);  // all other files are smaller
  fs::remove(map_);
  const ProgramResult result =
      RunProgram("rgbd_tum", {path_, "--output", output_, "--save-map", map_});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.output.find("12 frames: 12 tracked"), std::string::npos) << result.output;
  EXPECT_NE(result.errors.find(map_.string() + ": cannot be written: File too large"),
            std::string::npos)
      << result.errors;
  EXPECT_FALSE(fs::exists(map_));
  EXPECT_EQ(Summary()["trajectory"]["tracked"], 12);
}

TEST_F(RgbdMap, AnInterruptedRunSavesItsMap) {
  const PlaneSequence slow(12, 0.5);
  RunningProgram program("rgbd_tum",
                         {slow.path(), "--realtime", "--output", output_, "--save-map", map_});
  ASSERT_FALSE(program.ReadLine("frame ").empty());
  program.Send(SIGINT);
  EXPECT_EQ(program.Wait(), 1);
  EXPECT_EQ(ReadMap(map_).map.keyframes().size(), Summary()["map"]["keyframes"]);
}

TEST_F(RgbdMap, AKilledRunLeavesItsLastCheckpoint) {
  const PlaneSequence slow(12, 0.5);
  RunningProgram program("rgbd_tum", {slow.path(), "--realtime", "--output", output_, "--save-map",
                                      map_, "--checkpoint", "0.05"});
  while (!fs::exists(map_)) {
    ASSERT_FALSE(program.ReadLine("frame ").empty());
  }
  program.Send(SIGKILL);
  program.Wait();
  const size_t keyframes = ReadMap(map_).map.keyframes().size();
  EXPECT_GE(keyframes, 1U);
  EXPECT_FALSE(fs::exists(output_ / "summary.json"));
  ASSERT_EQ(Run({"--load-map", map_, "--save-map", map_}).exit_code, 0);
  EXPECT_GE(ReadMap(map_).map.keyframes().size(), keyframes);
}

TEST_F(RgbdMap, BadUsageIsRefused) {
  ExpectRefusal({"--checkpoint", "60"}, {"--checkpoint", "--save-map"});
  ExpectRefusal({"--save-map", map_, "--checkpoint", "0"}, {"--checkpoint"});
  ExpectRefusal({"--localization"}, {"--localization", "--load-map"});
  ExpectRefusal({"--save-map", folder_.path() / "none" / "a.map"},
                {"none/a.map", "there is no folder"});
  ExpectRefusal({"--save-map", folder_.path()}, {folder_.path().string(), "not a regular file"});
  ExpectRefusal({"--save-map", output_ / "a.map"}, {"--save-map", "output folder"});
  ExpectRefusal({"--save-map", path_ + "/rgb/a.map"}, {"--save-map", "reads"});
}

TEST_F(RgbdMap, BadMapsAreRefused) {
  ExpectRefusal({"--load-map", map_}, {map_.string(), "No such file"});
  ExpectRefusal({"--load-map", path_ + "/rgb.txt"}, {"rgb.txt", "is not a map"});
  Save();
  ExpectRefusal({"--load-map", map_, "--set", "Camera.fx=501"},
                {map_.string(), "Camera.fx 500", "501"});
  ExpectRefusal({"--load-map", map_, "--set", "ORBextractor.nLevels=7"},
                {map_.string(), "ORBextractor.nLevels 8", "7"});
  const ProgramResult result =
      RunProgram("rgbd_tum", {path_, "--load-map", map_, "--output", folder_.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("contains " + map_.string()), std::string::npos) << result.errors;
  fs::resize_file(map_, fs::file_size(map_) / 2);
  ExpectRefusal({"--load-map", map_}, {map_.string(), "damaged or cut off"});
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bags/mcap_bag.h"
#include "files/read_file.h"
#include "support/paths.h"
#include "support/rendered_desk.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;

constexpr int kBagFrames = 12;

// A rendered sequence with masks, its run by rgbd_tum, and recordings that a script of the tests
// makes of it.
class RgbdBag : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    desk_ = new RenderedDesk(kBagFrames);
    Arguments arguments = {desk_->path(), "--masks", desk_->path() / "masks"};
    Run("rgbd_tum", arguments, "tum", 0);
  }
  static void TearDownTestSuite() {
    delete desk_;
    delete folder_;
  }

  static std::string Path(const std::string& name) { return folder_->path() / name; }

  // Runs a program; the output folder is `out`.
  static ProgramResult Run(const std::string& program, Arguments arguments, const std::string& out,
                           int exit_code) {
    arguments.insert(arguments.end(), {"--output", Path(out)});
    const ProgramResult result = RunProgram(program, arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.errors;
    return result;
  }

  static std::string MakeBag(const std::string& name, const std::string& options) {
    const fs::path script = SourceFolder() / "tests/support/make_bag.py";
    EXPECT_EQ(RunShell("/usr/bin/python3 -B '" + script.string() + "' '" + desk_->path().string() +
                       "' '" + Path(name) + "' --settings '" + desk_->settings().string() + "' " +
                       options),
              0);
    return Path(name);
  }

  static void ExpectSameFile(const std::string& name, const std::string& out) {
    EXPECT_EQ(ReadFile(Path("tum/" + name)), ReadFile(Path(out + "/" + name))) << out << name;
  }

  static void ExpectRefusal(const std::string& program, const Arguments& arguments,
                            const std::vector<std::string>& parts) {
    const ProgramResult result = Run(program, arguments, "refused", 2);
    EXPECT_FALSE(fs::exists(Path("refused/summary.json")));
    for (const std::string& part : parts) {
      EXPECT_NE(result.errors.find(part), std::string::npos) << part << " in: " << result.errors;
    }
  }

  static TemporaryFolder* folder_;
  static RenderedDesk* desk_;
};

TemporaryFolder* RgbdBag::folder_ = nullptr;
RenderedDesk* RgbdBag::desk_ = nullptr;

TEST_F(RgbdBag, RecordingsGiveTheBytesOfTheFolder) {
  const std::map<std::string, std::string> bags = {
      {"raw.mcap", "--images raw"},
      {"files.db3", "--images files"},
      {"grey.bag", "--images raw-grey --compression bz2"}};
  for (const auto& [name, options] : bags) {
    const ProgramResult result = Run("rgbd_bag",
                                     {MakeBag(name, options), "--settings", desk_->settings(),
                                      "--masks", desk_->path() / "masks"},
                                     name + ".out", 0);
    EXPECT_NE(result.output.find("images: /camera/rgb/image_color"), std::string::npos)
        << result.output;
    for (const char* const file : {"trajectory.txt", "keyframes.txt", "map.ply", "objects.csv"}) {
      ExpectSameFile(file, name + ".out");
    }
  }
}

TEST_F(RgbdBag, TheCameraIsThatOfTheRecording) {
  const std::string bag = MakeBag("info.mcap", "");
  const std::string truth = desk_->path() / "groundtruth.txt";
  Run("rgbd_bag", {bag, "--set", "DepthMapFactor=5000", "--groundtruth", truth}, "info", 0);
  const auto summary = nlohmann::json::parse(ReadFile(Path("info/summary.json")));
  EXPECT_LE(summary["trajectory"]["ate_rmse_m"], 0.005);
  // Depth images of ROS are in millimetres, so without the factor everything is five times as far.
  const ProgramResult in_mm = Run("rgbd_bag", {bag}, "mm", 0);
  EXPECT_EQ(in_mm.errors.find("error"), std::string::npos) << in_mm.errors;
  Run("mono_bag", {bag, "--groundtruth", truth}, "mono", 0);
  Run("mono_tum", {desk_->path()}, "mono_tum", 0);
  const auto mono = nlohmann::json::parse(ReadFile(Path("mono/summary.json")));
  EXPECT_EQ(mono["trajectory"]["tracked"], kBagFrames);
  EXPECT_LE(mono["trajectory"]["ate_rmse_m"], 0.005);
}

TEST_F(RgbdBag, BadInputIsRefusedWithTheTopics) {
  const std::string bag = MakeBag("bad.mcap", "");
  ExpectRefusal("rgbd_bag", {bag, "--image-topic", "/none"},
                {"bad.mcap: --image-topic is '/none'", "its topics: /camera/depth/image"});
  ExpectRefusal("rgbd_bag", {bag, "--associations", "a.txt"}, {"--associations is given"});
  ExpectRefusal("mono_bag", {desk_->path() / "rgb.txt"}, {"rgb.txt: is no bag"});
  ExpectRefusal("mono_bag", {Path("none.bag")}, {"none.bag: No such file"});
  const std::string late = folder_->Write("late.txt", "9000000 0 0 0 0 0 0 1\n");
  ExpectRefusal("mono_bag", {bag, "--groundtruth", late}, {"late.txt", "stamps of the same clock"});
}

TEST_F(RgbdBag, ImagesOfAChosenTopicAreFoundAgain) {
  const std::string bag = MakeBag("two.mcap", "--second-topic /camera/rgb/second");
  ExpectRefusal("rgbd_bag", {bag}, {"--image-topic", "/camera/rgb/second"});
  Run("rgbd_bag", {bag, "--image-topic", "/camera/rgb/second", "--save-map", Path("two.map")},
      "two", 0);
  const ProgramResult result = RunProgram(
      "hullslam export", {Path("two"), "--to", "nerfstudio", "--output", Path("two_nerf")});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(fs::exists(Path("two_nerf/images")));
}

TEST_F(RgbdBag, ACutRecordingIsUsedWithAWarning) {
  const std::string whole = ReadFile(MakeBag("whole.mcap", ""));
  const std::string cut = folder_->Write("cut.mcap", whole.substr(0, whole.size() * 3 / 4));
  const ProgramResult result = Run("rgbd_bag", {cut, "--settings", desk_->settings()}, "cut", 0);
  EXPECT_NE(result.errors.find("warning: " + cut + ": ends at byte"), std::string::npos)
      << result.errors;
}

TEST_F(RgbdBag, ARunIsWrittenAsARecordingThatCanBeRunAgain) {
  const Arguments arguments = {desk_->path(), "--masks", desk_->path() / "masks", "--quiet"};
  for (const char* const name : {"a.mcap", "b.mcap"}) {
    Arguments with_file = arguments;
    with_file.insert(with_file.end(), {"--mcap", Path(name)});
    Run("rgbd_tum", with_file, "again", 0);
  }
  ExpectSameFile("trajectory.txt", "again");
  EXPECT_EQ(ReadFile(Path("a.mcap")), ReadFile(Path("b.mcap")));
  McapBag bag(Path("a.mcap"));
  bag.Scan([](const BagMessage&) {});
  std::map<std::string, size_t> counts;
  for (const BagTopic& topic : bag.topics()) {
    counts[topic.name] = topic.messages;
  }
  const std::map<std::string, size_t> expected = {{"/map/path", 1},
                                                  {"/map/points", 1},
                                                  {"/map/objects", 1},
                                                  {"/map/scene", 1},
                                                  {"/tf", kBagFrames},
                                                  {"/camera/camera_info", kBagFrames},
                                                  {"/camera/image/compressed", kBagFrames}};
  EXPECT_EQ(counts, expected);
  Run("mono_bag", {Path("a.mcap"), "--report"}, "from_mcap", 0);
}

TEST_F(RgbdBag, ARecordingThatCannotBeWrittenIsReported) {
  const Arguments arguments = {desk_->path(), "--last", "1", "--quiet", "--mcap"};
  Arguments inside = arguments;
  inside.push_back(Path("refused/run.mcap"));
  ExpectRefusal("rgbd_tum", inside, {"--mcap is '", "which is in the output folder"});
  Arguments nowhere = arguments;
  nowhere.push_back(Path("none/run.mcap"));
  ExpectRefusal("rgbd_tum", nowhere, {"--mcap is '", "there is no folder"});
  Arguments full = arguments;
  full.insert(full.end(), {Path("full.mcap"), "--output", Path("full")});
  const ProgramResult result = RunProgram("rgbd_tum", full, "ulimit -f 300; ");
  EXPECT_EQ(result.exit_code, 1) << result.errors;
  EXPECT_NE(result.errors.find("full.mcap: cannot be written"), std::string::npos) << result.errors;
  EXPECT_FALSE(fs::exists(Path("full.mcap")));
  EXPECT_TRUE(fs::exists(Path("full/summary.json")));
}

}  // namespace
}  // namespace hullslam

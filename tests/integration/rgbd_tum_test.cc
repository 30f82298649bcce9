// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bags/mcap_bag.h"
#include "bags/message_fields.h"
#include "files/text_rows.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "hullslam/results/trajectory_file.h"
#include "results/pose_file.h"
#include "support/made_vocabulary.h"
#include "support/plane_sequence.h"
#include "support/read_folder.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;
using Json = nlohmann::json;

// Replaces the content of a file. The destructor restores the former content.
class EditedFile {
 public:
  EditedFile(fs::path path, const std::string& content)
      : path_(std::move(path)), former_(ReadFile(path_)) {
    Write(content);
  }
  ~EditedFile() { Write(former_); }
  EditedFile(const EditedFile&) = delete;
  EditedFile& operator=(const EditedFile&) = delete;

 private:
  void Write(const std::string& content) const {
    std::ofstream(path_, std::ios::binary) << content;
  }

  fs::path path_;
  std::string former_;
};

std::string EncodePng(const cv::Mat& image) {
  std::vector<uchar> bytes;
  cv::imencode(".png", image, bytes);
  return {bytes.begin(), bytes.end()};
}

Arguments operator+(Arguments first, const Arguments& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

bool IsOneLine(const std::string& text) {
  return !text.empty() && text.find('\n') == text.size() - 1;
}

void ExpectParts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
  }
}

class RgbdTum : public ::testing::Test {
 protected:
  // Runs the program, expects exit code 0 and returns what the program printed.
  ProgramResult RunWell(const Arguments& arguments) const {
    ProgramResult result = RunProgram("rgbd_tum", arguments + Arguments{"--output", output_});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result;
  }

  Json Summary() const { return Json::parse(ReadFile(output_ / "summary.json")); }
  Trajectory Poses() const { return ReadTrajectory(output_ / "trajectory.txt"); }

  void ExpectStamps(const std::vector<int>& frames) const {
    const Trajectory poses = Poses();
    ASSERT_EQ(poses.size(), frames.size());
    for (size_t i = 0; i < frames.size(); ++i) {
      EXPECT_NEAR(poses[i].timestamp, sequence_.Stamp(frames[i]), 1e-6);
    }
  }

  TemporaryFolder folder_;
  fs::path output_ = folder_.path() / "out";
  PlaneSequence sequence_;
  std::string path_ = sequence_.path();
};

// ---- good input

TEST_F(RgbdTum, WritesAllResults) {
  const ProgramResult result = RunWell({path_});
  ExpectParts(result.output, {"12 frames: 12 tracked, 0 lost, 0 skipped", "ATE RMSE", "keyframe",
                              "frames/s", output_.string()});
  std::vector<std::string> names;
  for (const auto& [name, bytes] : ReadFolder(output_)) {
    names.push_back(name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"keyframes.txt", "map.ply", "settings.yaml",
                                             "summary.json", "trajectory.txt"}));
  ExpectStamps({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  EXPECT_FALSE(ReadTrajectory(output_ / "keyframes.txt").empty());
  EXPECT_TRUE(ReadFile(output_ / "map.ply").starts_with("ply\n"));
  const Json trajectory = Summary()["trajectory"];
  EXPECT_LE(trajectory["ate_rmse_m"].get<double>(), 0.010);
  EXPECT_EQ(trajectory["pairs"], 12);
  EXPECT_EQ(trajectory["frames"], 12);
  EXPECT_EQ(trajectory["tracked"], 12);
  EXPECT_EQ(trajectory["lost"], 0);
  EXPECT_EQ(trajectory["skipped"], 0);
}

TEST_F(RgbdTum, PrintsWhichSettingsItTakesAndWhy) {
  const std::string own = path_ + "/camera.yaml";
  ExpectParts(RunWell({path_, "--last", "2"}).output,
              {"settings: " + own + " (in the folder of the sequence)"});
  ExpectParts(RunWell({path_, "--last", "2", "--settings", own}).output,
              {"settings: " + own + " (as --settings says)"});
  const fs::path by_name = folder_.path() / "rgbd_dataset_freiburg1_wall";
  fs::copy(path_, by_name, fs::copy_options::recursive);
  fs::remove(by_name / "camera.yaml");
  ExpectParts(RunWell({by_name, "--last", "2"}).output,
              {"TUM1.yaml (by the name of the folder of the sequence)"});
}

// A recording of a user: images that are named by their numbers or time stamps, and no lists.
TEST_F(RgbdTum, FoldersWithoutListsSimplyRun) {
  RunWell({path_, "--quiet"});
  const Trajectory listed = Poses();
  for (const char* const list : {"rgb.txt", "depth.txt", "groundtruth.txt", "associations.txt"}) {
    fs::remove(sequence_.path() / list);
  }
  ExpectParts(RunWell({path_}).output, {"no rgb.txt", "numbers of frames, 30 per second"});
  const Trajectory numbered = Poses();
  ASSERT_EQ(numbered.size(), listed.size());
  EXPECT_NEAR(numbered[3].timestamp, 3 / 30.0, 1e-6);
  EXPECT_LT((numbered.back().world_from_cam.translation - listed.back().world_from_cam.translation)
                .norm(),
            0.005);
  for (int i = 0; i < 12; ++i) {
    for (const char* const kind : {"rgb", "depth"}) {
      fs::rename(sequence_.path() / kind / fmt::format("{:02}.png", i),
                 sequence_.path() / kind / fmt::format("{:.6f}.png", sequence_.Stamp(i)));
    }
  }
  ExpectParts(RunWell({path_}).output, {"the names of the images are time stamps"});
  EXPECT_NEAR(Poses().back().timestamp, sequence_.Stamp(11), 1e-6);
}

TEST_F(RgbdTum, SummaryHasAllKeys) {
  RunWell({path_, "--seed", "7"});
  const Json summary = Summary();
  const std::map<std::string, std::vector<std::string>> keys = {
      {"trajectory",
       {"ate_rmse_m", "alignment", "scale", "pairs", "frames", "tracked", "lost", "poses"}},
      {"timing", {"track_ms", "stages_ms", "total_s", "frames_per_second"}},
      {"memory", {"peak_mb"}},
      {"map", {"keyframes", "landmarks", "loops"}},
      {"provenance",
       {"program", "version", "git", "settings_hash", "preset", "seed", "pipeline", "masks_format",
        "sequence"}}};
  for (const auto& [group, names] : keys) {
    for (const std::string& name : names) {
      EXPECT_TRUE(summary[group].contains(name)) << group << '.' << name;
    }
  }
  for (const char* const name : {"median", "mean", "p95", "max"}) {
    EXPECT_GT(summary["timing"]["track_ms"][name].get<double>(), 0.0) << name;
  }
  EXPECT_GT(summary["memory"]["peak_mb"].get<double>(), 0.0);
  EXPECT_GE(summary["map"]["keyframes"].get<int>(), 1);
  EXPECT_GE(summary["map"]["landmarks"].get<int>(), 100);
  EXPECT_FALSE(summary.contains("initialisation"));
  EXPECT_EQ(summary["provenance"]["seed"], 7);
  EXPECT_EQ(summary["provenance"]["pipeline"], "sequential");
  EXPECT_EQ(summary["provenance"]["sequence"], path_);
}

TEST_F(RgbdTum, SequentialRunsGiveTheSameBytes) {
  RunWell({path_});
  const auto first = ReadFolder(output_);
  RunWell({path_});
  const auto second = ReadFolder(output_);
  for (const char* const name : {"trajectory.txt", "keyframes.txt", "map.ply"}) {
    EXPECT_TRUE(first.at(name) == second.at(name)) << name;
  }
}

TEST_F(RgbdTum, ThreadedRunIsAsGood) {
  for (const Arguments& more : {Arguments{}, Arguments{"--realtime"}}) {
    RunWell(Arguments{path_, "--threaded"} + more);
    EXPECT_EQ(Summary()["trajectory"]["tracked"], 12);
    EXPECT_LE(Summary()["trajectory"]["ate_rmse_m"].get<double>(), 0.010);
    EXPECT_EQ(Summary()["provenance"]["pipeline"], "threaded");
  }
}

TEST_F(RgbdTum, TakesTheFourArgumentsOfOrbSlam2) {
  const fs::path vocabulary = folder_.path() / "ORBvoc.txt";
  WriteVocabulary(vocabulary, MadeVocabulary(), VocabularyForm::kText);
  const ProgramResult result =
      RunWell({vocabulary, path_ + "/camera.yaml", path_, path_ + "/associations.txt", "--quiet"});
  EXPECT_EQ(result.errors, "");
  EXPECT_EQ(Poses().size(), 12U);
}

TEST_F(RgbdTum, TheVocabularyIsTheDefaultOrAFileOrNone) {
  const fs::path file = folder_.path() / "small.bow";
  WriteVocabulary(file, MadeVocabulary(), VocabularyForm::kBinary);
  RunWell({path_, "--last", "5"});
  const double error = Summary()["trajectory"]["ate_rmse_m"].get<double>();
  for (const std::string& vocabulary : {file.string(), std::string("none")}) {
    RunWell({path_, "--last", "5", "--vocabulary", vocabulary});
    EXPECT_EQ(Summary()["trajectory"]["tracked"], 6);
    EXPECT_NEAR(Summary()["trajectory"]["ate_rmse_m"].get<double>(), error, 0.002)
        << "the words change the matches of the second frame, but not how good they are";
  }
}

// The texture of the wall repeats after 2.72 m, so another part of the wall looks like the start.
// The drift budget refuses this loop unless it is set so large that the drift could explain it.
TEST_F(RgbdTum, ClosesALoopOnlyIfDriftMayExplainIt) {
  const PlaneSequence wall(40, 0.1, 40, 1360);
  const auto loops = [&](const Arguments& more) {
    RunWell(Arguments{wall.path(), "--quiet"} + more);
    return Summary()["map"]["loops"].get<int>();
  };
  EXPECT_EQ(loops({}), 0);
  EXPECT_LE(Summary()["trajectory"]["ate_rmse_m"].get<double>(), 0.02);
  const Arguments large = {"--set", "loop.drift_base=3", "--set", "loop.turn_base=3"};
  EXPECT_EQ(loops(large), 1);
  EXPECT_EQ(loops(large + Arguments{"--vocabulary", "none"}), 0);
}

// The odometry is that of a body whose axes are not those of the camera.
TEST_F(RgbdTum, WarnsOfAnOdometryThatLandmarksContradict) {
  const PlaneSequence wall(20);
  const fs::path file = folder_.path() / "wheels.txt";
  Trajectory wheels = ReadTrajectory(wall.path() / "groundtruth.txt");
  const auto run = [&] {
    WriteTrajectory(file, wheels);
    return RunWell({wall.path(), "--quiet", "--odometry", file}).errors;
  };
  EXPECT_EQ(run(), "");
  for (StampedPose& pose : wheels) {
    std::swap(pose.world_from_cam.translation.x(), pose.world_from_cam.translation.z());
  }
  ExpectParts(run(), {"warning: ", "contradicted by", "not of the body"});
}

// The loop is a wrong one, so that it moves the map far.
TEST_F(RgbdTum, ARecordingOfLivePosesHasTheTransformsOfRos) {
  const PlaneSequence wall(40, 0.1, 40, 1360);
  const fs::path file = folder_.path() / "run.mcap";
  RunWell({wall.path(), "--quiet", "--live-poses", "--mcap", file, "--set", "loop.drift_base=3",
           "--set", "loop.turn_base=3"});
  ASSERT_EQ(Summary()["map"]["loops"], 1);
  std::vector<Rigid3> maps_from_odom;
  std::vector<Rigid3> odoms_from_cam;
  std::vector<Rigid3> of_odometry;
  std::vector<double> variances;  // of x
  McapBag bag(file);
  bag.Scan([&](const BagMessage& message) {
    FieldReader reader(MessageCoding::kCdr, message.bytes, file);
    const auto pose = [&](const std::string& parent, const std::string& child) {
      reader.Get<int32_t>();
      reader.Get<uint32_t>();
      EXPECT_EQ(reader.GetText(), parent);
      EXPECT_EQ(reader.GetText(), child);
      std::array<double, 7> numbers{};
      std::ranges::generate(numbers, [&] { return reader.Get<double>(); });
      return Rigid3(Eigen::Quaterniond(&numbers[3]), Eigen::Vector3d(numbers.data()));
    };
    const std::string& topic = bag.topics()[message.topic].name;
    if (topic == "/tf") {
      EXPECT_EQ(reader.Get<uint32_t>(), 2U);
      maps_from_odom.push_back(pose("map", "odom"));
      odoms_from_cam.push_back(pose("odom", "camera"));
    } else if (topic == "/odom") {
      of_odometry.push_back(pose("odom", "camera"));
      variances.push_back(reader.Get<double>());
    }
  });
  const Trajectory live = ReadPoseFile(output_ / "live_poses.txt").poses;
  ASSERT_EQ(live.size(), 40U);
  ASSERT_EQ(maps_from_odom.size(), live.size());
  ASSERT_EQ(of_odometry.size(), live.size());
  double most_moved = 0.0;
  for (size_t i = 0; i < live.size(); ++i) {
    const Rigid3 composed = maps_from_odom[i] * odoms_from_cam[i];
    EXPECT_LT((composed.translation - live[i].world_from_cam.translation).norm(), 1e-8) << i;
    EXPECT_LT(AngularDistance(composed.rotation, live[i].world_from_cam.rotation), 1e-8) << i;
    EXPECT_EQ(of_odometry[i].translation, odoms_from_cam[i].translation) << i;
    EXPECT_EQ(variances[i] > 0.0, i > 0) << i;
    if (i > 0) {
      const double step =
          (odoms_from_cam[i].translation - odoms_from_cam[i - 1].translation).norm();
      EXPECT_NEAR(step, 0.08, 0.02) << "the odometry jumps at " << i;
      most_moved = std::max(
          most_moved, (maps_from_odom[i].translation - maps_from_odom[i - 1].translation).norm());
    }
  }
  EXPECT_GT(most_moved, 0.5);
}

TEST_F(RgbdTum, ABrokenVocabularyIsRefused) {
  const auto refuse = [&](const std::string& vocabulary, const std::string& why) {
    const ProgramResult result =
        RunProgram("rgbd_tum", {path_, "--vocabulary", vocabulary, "--output", output_});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(IsOneLine(result.errors)) << result.errors;
    ExpectParts(result.errors, {vocabulary, why});
    EXPECT_FALSE(fs::exists(output_));
  };
  refuse(folder_.path() / "none.bow", "No such file");
  refuse(folder_.Write("empty.bow", ""), "is empty");
  refuse(folder_.Write("cut.bow", BytesOf(MadeVocabulary()).substr(0, 99)), "cut off");
  refuse(path_ + "/camera.yaml", "is not a vocabulary");
  refuse(folder_.Write("voc.txt", "10 6 0 0\n0 1 5\n"), "voc.txt:2: ");
}

TEST_F(RgbdTum, SetOverridesASettingBeforeAndAfterTheSequence) {
  RunWell({path_});
  const std::string plain = Summary()["provenance"]["settings_hash"];
  RunWell({path_, "--set", "ORBextractor.nFeatures=500"});
  const std::string changed = Summary()["provenance"]["settings_hash"];
  EXPECT_NE(changed, plain);
  RunWell({"--set", "ORBextractor.nFeatures=500", path_});
  EXPECT_EQ(Summary()["provenance"]["settings_hash"], changed);
  RunWell({"--set", "ORBextractor.nFeatures=500", "--set", "ThDepth=30", path_});
  EXPECT_NE(Summary()["provenance"]["settings_hash"], changed);
}

TEST_F(RgbdTum, RunsAPartOfTheSequence) {
  RunWell({path_, "--first", "2", "--last", "9", "--stride", "3"});
  ExpectStamps({2, 5, 8});
  RunWell({path_, "--last", "100", "--first", "11"});
  ExpectStamps({11});
}

TEST_F(RgbdTum, WithoutGroundTruthThereIsNoError) {
  fs::remove(sequence_.path() / "groundtruth.txt");
  const ProgramResult result = RunWell({path_, "--last", "2", "--quiet"});
  EXPECT_EQ(result.errors, "");
  EXPECT_TRUE(Summary()["trajectory"]["ate_rmse_m"].is_null());
}

TEST_F(RgbdTum, QuietPrintsNothing) {
  const ProgramResult result = RunWell({path_, "--quiet"});
  EXPECT_EQ(result.output, "");
  EXPECT_EQ(result.errors, "");
}

TEST_F(RgbdTum, HelpAndVersionAreNoErrors) {
  const ProgramResult help = RunProgram("rgbd_tum", {"--help"});
  EXPECT_EQ(help.exit_code, 0);
  ExpectParts(help.output, {"--settings", "--set", "--output", "--threaded", "--realtime",
                            "--first", "--stride", "--strict", "--quiet", "Exit codes"});
  const ProgramResult version = RunProgram("rgbd_tum", {"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(IsOneLine(version.output)) << version.output;
  EXPECT_EQ(help.errors + version.errors, "");
}

// The settings of the sequence itself are in its folder.
TEST_F(RgbdTum, WarnsOfSettingsOfAnotherCamera) {
  const auto run = [&](const std::string& focal_length) {
    const std::string settings =
        folder_.Write("other.yaml", "%YAML:1.0\nCamera.fx: " + focal_length +
                                        "\nCamera.fy: 500.0\nCamera.cx: 319.5\nCamera.cy: 239.5\n"
                                        "Camera.bf: 40.0\nDepthMapFactor: 5000.0\n");
    return RunWell({path_, "--last", "2", "--quiet", "--settings", settings}).errors;
  };
  EXPECT_EQ(run("500.5"), "");
  ExpectParts(run("520.0"), {"warning: ", "other.yaml: Camera.fx is 520", path_ + "/camera.yaml",
                             "have 500", "another camera?"});
}

TEST(RgbdTumData, DepthThatIsNotRegisteredIsReported) {
  const TemporaryFolder folder;
  const fs::path desk = folder.path() / "desk";
  ASSERT_EQ(RunProgram("make_synthetic", {desk, "--frames", "8", "--quiet"}).exit_code, 0);
  const auto run = [&] {
    const ProgramResult result =
        RunProgram("rgbd_tum", {desk, "--output", folder.path() / "out", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.errors;
  };
  EXPECT_EQ(run(), "");
  for (const fs::directory_entry& file : fs::directory_iterator(desk / "depth")) {
    const cv::Mat depth = cv::imread(file.path().string(), cv::IMREAD_UNCHANGED);
    cv::Mat moved = cv::Mat::zeros(depth.size(), depth.type());
    const cv::Size size(depth.cols - 14, depth.rows - 8);
    depth(cv::Rect({0, 0}, size)).copyTo(moved(cv::Rect({14, 8}, size)));
    cv::imwrite(file.path().string(), moved);
  }
  ExpectParts(run(), {"warning: ", "registered to the colour images?"});
}

TEST(RgbdTumData, RenderedDeskIsTracked) {
  const TemporaryFolder folder;
  const std::string desk = folder.path() / "desk";
  ASSERT_EQ(RunProgram("make_synthetic", {desk, "--frames", "12", "--quiet"}).exit_code, 0);
  const fs::path out = folder.path() / "out";
  const ProgramResult result = RunProgram("rgbd_tum", {desk, "--output", out});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Json trajectory = Json::parse(ReadFile(out / "summary.json"))["trajectory"];
  EXPECT_EQ(trajectory["tracked"], 12);
  EXPECT_LE(trajectory["ate_rmse_m"].get<double>(), 0.010);
}

TEST(RgbdTumData, RealSequenceIsTrackedToTheEnd) {
  const auto data = FindTestData("fr1_xyz");
  if (!data) {
    GTEST_SKIP() << "fr1_xyz is not on this machine; set HULLSLAM_DATA";
  }
  const TemporaryFolder folder;
  const ProgramResult result =
      RunProgram("rgbd_tum", {*data, "--output", folder.path(), "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Json trajectory = Json::parse(ReadFile(folder.path() / "summary.json"))["trajectory"];
  EXPECT_EQ(trajectory["lost"], 0);
  EXPECT_EQ(trajectory["skipped"], 0);
  EXPECT_EQ(trajectory["tracked"], trajectory["frames"]);
  EXPECT_GE(trajectory["frames"].get<int>(), 790);
  EXPECT_LE(trajectory["ate_rmse_m"].get<double>(), 0.0100);
}

// ---- bad input

class RgbdTumRefuses : public RgbdTum {
 protected:
  RgbdTumRefuses() {
    RunWell({path_, "--last", "2"});
    former_ = ReadFolder(output_);
  }

  // Expects exit code 2, nothing on stdout, one line on stderr that contains all `parts`, and that
  // the results of the former run are unchanged.
  void ExpectRefusal(const Arguments& arguments, const std::vector<std::string>& parts,
                     const std::string& setup = "") const {
    Expect(arguments + Arguments{"--output", output_}, parts, setup);
    EXPECT_TRUE(ReadFolder(output_) == former_) << "the results of the former run were changed";
  }

  static void Expect(const Arguments& arguments, const std::vector<std::string>& parts,
                     const std::string& setup = "") {
    const ProgramResult result = RunProgram("rgbd_tum", arguments, setup);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_TRUE(result.errors.starts_with("error: ")) << result.errors;
    EXPECT_TRUE(IsOneLine(result.errors)) << result.errors;
    ExpectParts(result.errors, parts);
  }

  // Expects a refusal after a file of the sequence gets another content.
  void ExpectRefusalOf(const std::string& name, const std::string& content,
                       const std::vector<std::string>& parts) const {
    const EditedFile edited(sequence_.path() / name, content);
    ExpectRefusal({path_}, parts);
  }

  std::map<std::string, std::string> former_;
};

TEST_F(RgbdTumRefuses, WhatIsMissing) {
  ExpectRefusal({path_ + "/none"}, {path_ + "/none"});
  ExpectRefusal({path_, "--settings", path_ + "/none.yaml"}, {path_ + "/none.yaml"});
  ExpectRefusal({path_, "--associations", path_ + "/none.txt"}, {path_ + "/none.txt"});
  fs::remove(sequence_.path() / "rgb/07.png");
  fs::remove(sequence_.path() / "rgb/08.png");  // more than a tenth of the images
  ExpectRefusal({path_}, {path_ + "/rgb/07.png", "missing"});
  fs::remove(sequence_.path() / "depth.txt");
  ExpectRefusal({path_}, {path_, "has no depth.txt", "without depth: mono_tum"});
}

TEST_F(RgbdTumRefuses, AFolderOneLevelTooHighOrTooLow) {
  const std::string meant = "did you mean " + fs::canonical(path_).string() + "?";
  ExpectRefusal({path_ + "/rgb"}, {meant});
  fs::create_directory_symlink(path_, folder_.path() / "desk");
  ExpectRefusal({folder_.path()},
                {"did you mean " + (fs::canonical(folder_.path()) / "desk").string() + "?"});
}

TEST_F(RgbdTumRefuses, AVocabularyInThePlaceOfTheSettings) {
  const fs::path text = folder_.path() / "ORBvoc.txt";
  WriteVocabulary(text, MadeVocabulary(), VocabularyForm::kText);
  const std::string settings = path_ + "/camera.yaml";
  for (const std::string& vocabulary : {text.string(), FindDefaultVocabulary().string()}) {
    ExpectRefusal({settings, vocabulary, path_, path_ + "/associations.txt"},
                  {vocabulary + " is a vocabulary",
                   "the order is VOCABULARY SETTINGS SEQUENCE ASSOCIATIONS"});
  }
}

TEST_F(RgbdTumRefuses, AnUnknownOptionIsComparedWithTheKnownOnes) {
  ExpectRefusal({path_, "--mask", "masks"}, {"--mask", "did you mean --masks?"});
  ExpectRefusal({path_, "--localisation"}, {"did you mean --localization?"});
  ExpectRefusal({path_, "--ouptut=a"}, {"did you mean --output?"});
  const ProgramResult other = RunProgram("rgbd_tum", {path_, "--aardvark"});
  EXPECT_EQ(other.errors.find("did you mean"), std::string::npos) << other.errors;
}

TEST_F(RgbdTumRefuses, AMapInAFolderThatDoesNotExist) {
  const fs::path map = folder_.path() / "maps" / "desk.map";
  ExpectRefusal({path_, "--save-map", map},
                {"--save-map is '" + map.string() + "'", "there is no folder", "/maps"});
}

TEST_F(RgbdTumRefuses, SizesThatAreNotInMetres) {
  ExpectRefusal({path_, "--set", "objects.sizes=keyboard:46"}, {"keyboard:46", "0.001 to 20"});
  const ProgramResult result = RunProgram("rgbd_tum", {path_, "--last", "2", "--quiet", "--output",
                                                       output_, "--set", "objects.sizes=cup:10"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  ExpectParts(result.errors, {"warning: objects.sizes", "'cup' is 10 m", "in metres"});
}

TEST_F(RgbdTum, WarnsOfDepthInAnotherUnit) {
  for (const auto& [factor, metres] : {std::pair("800", "6.25 m"), std::pair("20000", "0.25 m")}) {
    const ProgramResult result =
        RunProgram("rgbd_tum", {path_, "--last", "2", "--quiet", "--output", output_, "--set",
                                std::string("DepthMapFactor=") + factor});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    ExpectParts(result.errors, {"warning: ", metres, "is DepthMapFactor right?"});
  }
}

// A factor that is wrong by 1.5 leaves depths plausible, but not the size of the trajectory.
TEST_F(RgbdTum, WarnsIfTheTrajectoryHasAnotherSizeThanTheGroundTruth) {
  for (const auto& [factor, warning] :
       {std::pair("3333.3", "warning: the trajectory is 1.5 times as large as the ground truth"),
        std::pair("5000", "")}) {
    const ProgramResult result = RunProgram(
        "rgbd_tum",
        {path_, "--quiet", "--output", output_, "--set", std::string("DepthMapFactor=") + factor});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    ExpectParts(result.errors, {warning});
    EXPECT_EQ(result.errors.find("as large as") != std::string::npos, *warning != 0)
        << result.errors;
  }
}

TEST_F(RgbdTumRefuses, ToReplaceARunOfAnotherProgram) {
  const fs::path other = folder_.path() / "other";
  fs::create_directory(other);
  for (const auto& [name, bytes] : former_) {
    std::string text = bytes;
    if (const size_t at = text.find("rgbd_tum");
        name == "summary.json" && at != std::string::npos) {
      text.replace(at, 8, "mono_tum");
    }
    std::ofstream(other / name, std::ios::binary) << text;
  }
  Expect({path_, "--output", other}, {other.string(), "a run of mono_tum", "--overwrite"});
  EXPECT_EQ(ReadFolder(other).size(), former_.size());
  const ProgramResult result =
      RunProgram("rgbd_tum", {path_, "--last", "2", "--output", other, "--overwrite"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(Json::parse(ReadFile(other / "summary.json"))["provenance"]["program"], "rgbd_tum");
}

TEST_F(RgbdTumRefuses, BadSettings) {
  const std::string good = ReadFile(sequence_.path() / "camera.yaml");
  const auto refuse = [&](const std::string& line, const std::vector<std::string>& parts) {
    ExpectRefusalOf("camera.yaml", good + line + '\n', parts);
  };
  const std::string origin = path_ + "/camera.yaml:13: ";  // the line after the good ones
  refuse("Camera.fz: 500.0", {origin, "unknown key 'Camera.fz'", "Camera.f"});
  refuse("Camera.k1: wide", {origin, "Camera.k1 is 'wide'", "a number"});
  refuse("ORBextractor.nLevels: 2.5", {origin, "ORBextractor.nLevels is '2.5'", "an integer"});
  refuse("Camera.fx: 510.0", {origin, "Camera.fx"});
  const auto replace = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  ExpectRefusalOf("camera.yaml", replace("fx: 500.0", "fx: 0.0"),
                  {path_ + "/camera.yaml:2: ", "Camera.fx is '0'", "from 10"});
  ExpectRefusalOf("camera.yaml", replace("nFeatures: 600", "nFeatures: -600"),
                  {path_ + "/camera.yaml:12: ", "ORBextractor.nFeatures is '-600'"});
  ExpectRefusalOf("camera.yaml", replace("Camera.fx: 500.0\n", ""),
                  {path_ + "/camera.yaml", "Camera.fx"});
  ExpectRefusalOf("camera.yaml", "", {path_ + "/camera.yaml"});
}

TEST_F(RgbdTumRefuses, BadOverrides) {
  ExpectRefusal({path_, "--set", "Camera.fz=500"}, {"--set", "unknown key 'Camera.fz'"});
  ExpectRefusal({path_, "--set", "Camera.fx=wide"}, {"--set", "Camera.fx is 'wide'", "a number"});
  ExpectRefusal({path_, "--set", "Camera.fx=0"}, {"--set", "Camera.fx is '0'"});
  ExpectRefusal({path_, "--set", "ORBextractor.nFeatures=-5"},
                {"--set", "ORBextractor.nFeatures is '-5'", "an integer"});
  ExpectRefusal({path_, "--set", "Camera.fx"}, {"--set", "'Camera.fx'", "key=value"});
}

TEST_F(RgbdTumRefuses, BrokenFirstImages) {
  const std::string depth = path_ + "/depth/00.png";
  const std::string good = ReadFile(depth);
  ExpectRefusalOf("depth/00.png", "", {depth, "empty"});
  ExpectRefusalOf("depth/00.png", "no image", {depth});
  ExpectRefusalOf("depth/00.png", good.substr(0, good.size() / 2), {depth, "cut off"});
  std::string broken = good;
  broken.replace(60, 40, std::string(40, '\x55'));
  ExpectRefusalOf("depth/00.png", broken, {depth, "broken"});
  ExpectRefusalOf("depth/00.png", EncodePng(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90))),
                  {depth, "8 bits", "16 bits"});
  ExpectRefusalOf("depth/00.png", EncodePng(cv::Mat(200, 320, CV_16UC1, cv::Scalar(5000))),
                  {depth, "320x200", "640x480"});
  ExpectRefusalOf("rgb/00.png", "", {path_ + "/rgb/00.png", "empty"});
}

TEST_F(RgbdTumRefuses, ImagesOfAnotherSizeThanTheSettings) {
  ExpectRefusal({path_, "--set", "Camera.width=320"},
                {path_ + "/rgb/00.png", "640x480", "320x480", "Camera.width"});
}

TEST_F(RgbdTumRefuses, BrokenLists) {
  ExpectRefusalOf("rgb.txt", "1.0 rgb/00.png\n2.0 rgb/01.png\n1.5 rgb/02.png\n",
                  {path_ + "/rgb.txt:3: ", "1.5"});
  ExpectRefusalOf("rgb.txt", "1.0\n", {path_ + "/rgb.txt:1: "});
  ExpectRefusalOf("rgb.txt", "soon rgb/00.png\n", {path_ + "/rgb.txt:1: ", "'soon'"});
  ExpectRefusalOf("depth.txt", "", {path_ + "/depth.txt", "no images"});
  // The nearest colour image in time is the one at 1000 s.
  ExpectRefusalOf("depth.txt", "999.97 depth/00.png\n", {path_, "0.02 s", "smallest gap is 0.03"});
  const std::string pairs = path_ + "/associations.txt";
  const EditedFile edited(pairs, "1.0 rgb/00.png 1.0 depth/00.png\n2.0 rgb/01.png 2.0\n");
  ExpectRefusal({path_, "--associations", pairs}, {pairs + ":2: ", "expected 4"});
}

TEST_F(RgbdTumRefuses, BadUsage) {
  ExpectRefusal({}, {"0 positional arguments", "SEQUENCE"});
  ExpectRefusal({path_, path_}, {"2 positional arguments", "SEQUENCE"});
  ExpectRefusal({path_, "--colour"}, {"--colour"});
  Expect({path_, "--set"}, {"--set"});
  ExpectRefusal({path_, "--stride", "0"}, {"--stride", "'0'", ">= 1"});
  ExpectRefusal({path_, "--stride", "-1"}, {"--stride", "'-1'", ">= 1"});
  ExpectRefusal({path_, "--first", "-1"}, {"--first", "'-1'", ">= 0"});
  ExpectRefusal({path_, "--first", "many"}, {"--first", "'many'"});
  ExpectRefusal({path_, "--first", "12"}, {"--first", "'12'", "12 frames"});
  ExpectRefusal({path_, "--first", "5", "--last", "4"}, {"--first", "--last"});
  ExpectRefusal({path_, "--seed", "-1"}, {"--seed", "'-1'"});
}

TEST_F(RgbdTumRefuses, OutputThatCannotBeWritten) {
  const fs::path file = folder_.Write("file", "precious");
  Expect({path_, "--output", file / "below"}, {(file / "below").string()});
  Expect({path_, "--output", file}, {file.string()});
  EXPECT_EQ(ReadFile(file), "precious");
}

// trajectory.txt is smaller than the limit, but map.ply is larger. No former file may be replaced.
TEST_F(RgbdTumRefuses, FilesThatMayNotGrow) {
  ExpectRefusal({path_, "--quiet"}, {(output_ / "settings.yaml").string(), "cannot be written"},
                "ulimit -f 4; ");
}

// Mounts a small disk at a folder, so that a test can fill it.
class SmallDisk {
 public:
  explicit SmallDisk(fs::path folder) : folder_(std::move(folder)) {
    fs::create_directory(folder_);
    is_mounted_ = Shell("mount -t tmpfs -o size=128k none");
  }
  ~SmallDisk() {
    if (is_mounted_) {
      Shell("umount");
    }
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool is_mounted() const { return is_mounted_; }

 private:
  bool Shell(const std::string& command) const {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): tests run programs one after the other
    return std::system((command + " '" + folder_.string() + "' 2>/dev/null").c_str()) == 0;
  }

  fs::path folder_;
  bool is_mounted_ = false;
};

TEST_F(RgbdTumRefuses, FullDisk) {
  const fs::path disk = folder_.path() / "disk";
  const SmallDisk mounted(disk);
  if (!mounted.is_mounted()) {
    GTEST_SKIP()
        << "cannot mount a small disk here; the test FilesThatMayNotGrow covers the same case";
  }
  fs::copy(output_, disk / "out");
  output_ = disk / "out";
  // Leaves room for one page: the check before the run passes and trajectory.txt still fits.
  std::ofstream filler(disk / "filler", std::ios::binary);
  while (fs::space(disk).available > 8192 && filler) {
    filler << std::string(4096, 'x') << std::flush;
  }
  ExpectRefusal({path_, "--quiet"}, {disk.string(), "No space left on device"});
  while (filler) {
    filler << std::string(4096, 'x') << std::flush;
  }
  ExpectRefusal({path_}, {disk.string(), "No space left on device"});
}

// ---- runs in which something goes wrong after the first frame

TEST_F(RgbdTum, BrokenImageInTheMiddleIsSkipped) {
  const std::string broken = path_ + "/depth/05.png";
  const EditedFile edited(broken, "");
  for (const Arguments& more : {Arguments{}, Arguments{"--threaded"}}) {
    const ProgramResult result = RunWell(Arguments{path_, "--quiet"} + more);
    EXPECT_TRUE(result.errors.starts_with("warning: " + broken)) << result.errors;
    EXPECT_TRUE(IsOneLine(result.errors)) << result.errors;
    ExpectStamps({0, 1, 2, 3, 4, 6, 7, 8, 9, 10, 11});
    EXPECT_EQ(Summary()["trajectory"]["skipped"], 1);
    EXPECT_EQ(Summary()["trajectory"]["frames"], 12);
    EXPECT_EQ(Summary()["trajectory"]["tracked"], 11);
  }
}

// The results of the frames before it take the place of the former ones (input_failure_test).
TEST_F(RgbdTumRefuses, BrokenImageInTheMiddleIfStrict) {
  const EditedFile edited(sequence_.path() / "rgb/05.png", "no image");
  for (const Arguments& more : {Arguments{}, Arguments{"--threaded"}}) {
    Expect(Arguments{path_, "--strict", "--quiet", "--output", output_} + more,
           {path_ + "/rgb/05.png"});
    EXPECT_FALSE(ReadFolder(output_) == former_);
  }
}

// Writes an association file, black.txt, in which frame `first` and the 39 frames after it are
// black.
void Blacken(const PlaneSequence& sequence, int first) {
  cv::imwrite(sequence.path() / "rgb/black.png", cv::Mat(480, 640, CV_8UC1, cv::Scalar(0)));
  std::string pairs;
  for (int i = 0; i < first + 40; ++i) {
    const std::string stamp = fmt::format("{:.6f}", sequence.Stamp(i));
    const std::string name = i < first ? fmt::format("{:02}", i) : "black";
    pairs += fmt::format("{} rgb/{}.png {} depth/00.png\n", stamp, name, stamp);
  }
  std::ofstream(sequence.path() / "black.txt") << pairs;
}

TEST_F(RgbdTum, LostForGoodIsAFailure) {
  for (const int good : {3, 0}) {
    Blacken(sequence_, good);
    const ProgramResult result =
        RunProgram("rgbd_tum",
                   {path_, "--associations", path_ + "/black.txt", "--quiet", "--output", output_});
    EXPECT_EQ(result.exit_code, 1);
    const size_t at = result.errors.find("error: ");
    ASSERT_NE(at, std::string::npos) << result.errors;
    ExpectParts(result.errors.substr(at), {"lost", std::to_string(good) + " of"});
    EXPECT_EQ(Summary()["trajectory"]["tracked"], good);
    EXPECT_EQ(Summary()["trajectory"]["lost"], 40);
  }
}

}  // namespace
}  // namespace hullslam

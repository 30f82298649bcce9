// SPDX-License-Identifier: GPL-3.0-or-later
// How runs end, and what they leave in their output folder.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/results/trajectory_file.h"
#include "support/plane_sequence.h"
#include "support/read_folder.h"
#include "support/run_program.h"
#include "support/running_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;
using Json = nlohmann::json;

class RunEnd : public ::testing::Test {
 protected:
  RunEnd() { folder_.Write("masks/00.txt", "41 0.25 0.25 0.5 0.25 0.5 0.5 0.25 0.5 0.9\n"); }

  ProgramResult Run(const Arguments& more, const std::string& program = "rgbd_tum") const {
    Arguments arguments = {path_, "--output", output_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunProgram(program, arguments);
  }

  ProgramResult MapObjects(const fs::path& poses, const fs::path& output) const {
    return RunProgram("hullslam map-objects",
                      {path_, "--poses", poses, "--masks", masks_, "--output", output, "--quiet"});
  }

  // Runs rgbd_tum with redirections of the shell and returns its exit code.
  int RunWith(const std::string& redirections) const {
    return RunShell(fmt::format("'{}' '{}' --output '{}' {}", ProgramPath("rgbd_tum").string(),
                                path_, output_.string(), redirections));
  }

  void ExpectError(const ProgramResult& result, int exit_code,
                   const std::vector<std::string>& parts) const {
    EXPECT_EQ(result.exit_code, exit_code) << result.errors;
    for (const std::string& part : parts) {
      EXPECT_NE(result.errors.find(part), std::string::npos)
          << "no '" << part << "' in: " << result.errors;
    }
  }

  Json Summary() const { return Json::parse(ReadFile(output_ / "summary.json")); }

  // Expects the complete files of a run over all frames, and nothing else.
  void ExpectResults() const {
    EXPECT_EQ(ReadFolder(output_).size(), 5U);
    EXPECT_EQ(ReadTrajectory(output_ / "trajectory.txt").size(), 12U);
    EXPECT_EQ(Summary()["trajectory"]["tracked"], 12);
  }

  TemporaryFolder folder_;
  fs::path output_ = folder_.path() / "out";
  PlaneSequence sequence_;
  std::string path_ = sequence_.path();
  std::string masks_ = folder_.path() / "masks";
};

// ---- the output folder

TEST_F(RunEnd, AFolderNeverMixesTwoRuns) {
  ASSERT_EQ(Run({"--masks", masks_}).exit_code, 0);
  EXPECT_TRUE(fs::exists(output_ / "objects.json"));
  EXPECT_EQ(Summary()["files"],
            (Json{"settings.yaml", "trajectory.txt", "keyframes.txt", "map.ply", "objects.json",
                  "objects_observations.json", "objects.csv", "objects.ply", "scene.json"}));
  ASSERT_EQ(Run({}).exit_code, 0);
  EXPECT_FALSE(fs::exists(output_ / "objects.json"));
  ExpectResults();
  ExpectError(RunProgram("hullslam evaluate", {"objects", output_}), 2,
              {output_.string(), "no masks", "--masks"});
}

TEST_F(RunEnd, TheOutputFolderIsApartFromTheInputs) {
  const auto images = ReadFolder(sequence_.path() / "rgb");
  output_ = sequence_.path() / "rgb";
  ExpectError(
      RunProgram("hullslam check-masks", {path_, masks_, "--output", output_, "--every", "1"}), 2,
      {"inside", path_});
  ExpectError(Run({}), 2, {"inside", path_});
  EXPECT_EQ(ReadFolder(sequence_.path() / "rgb"), images);
  output_ = masks_;
  ExpectError(Run({"--masks", masks_}), 2, {"contains", masks_});
  output_ = folder_.path() / "images";  // images that are in no folder of this run
  fs::copy(sequence_.path() / "rgb", output_);
  ExpectError(
      RunProgram("hullslam check-masks", {path_, masks_, "--output", output_, "--every", "1"}), 2,
      {"'0", "not from a former run"});
  ExpectError(Run({}), 2, {"'0", "not from a former run"});
  EXPECT_EQ(ReadFolder(output_), images);
}

TEST_F(RunEnd, PicturesReplaceFormerPicturesOnly) {
  const auto draw = [&](const char* every) {
    return RunProgram("hullslam check-masks",
                      {path_, masks_, "--output", output_, "--every", every});
  };
  ASSERT_EQ(draw("4").exit_code, 0);
  ASSERT_EQ(draw("6").exit_code, 0);
  std::vector<std::string> names;
  for (const auto& [name, bytes] : ReadFolder(output_)) {
    names.push_back(name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"00.png", "06.png", "pictures.json"}));
  output_ = folder_.path() / "run";
  ASSERT_EQ(Run({}).exit_code, 0);
  ExpectError(draw("6"), 2, {"not from a former run"});
  ExpectResults();
}

TEST_F(RunEnd, MappingObjectsDoesNotReplaceItsPoses) {
  ASSERT_EQ(Run({}).exit_code, 0);
  const auto former = ReadFolder(output_);
  ExpectError(MapObjects(output_ / "trajectory.txt", output_), 2,
              {"contains", "trajectory.txt", "reads"});
  EXPECT_EQ(ReadFolder(output_), former);
  EXPECT_EQ(MapObjects(output_ / "trajectory.txt", folder_.path() / "objects").exit_code, 0);
}

TEST_F(RunEnd, TheDefaultFoldersOfThePrograms) {
  const fs::path empty = folder_.path() / "empty";
  fs::create_directory(empty);
  const std::string setup = "cd '" + empty.string() + "'; ";
  ASSERT_EQ(RunProgram("rgbd_tum", {path_, "--quiet"}, setup).exit_code, 0);
  ASSERT_EQ(
      RunProgram("hullslam map-objects",
                 {path_, "--poses", "out/trajectory.txt", "--masks", masks_, "--quiet"}, setup)
          .exit_code,
      0);
  EXPECT_FALSE(fs::exists(empty / "out/objects.json"));
  EXPECT_TRUE(fs::exists(empty / "out_objects/objects.json"));
}

TEST_F(RunEnd, AFolderNamedLikeAResultIsNoticedBeforeTheRun) {
  fs::create_directories(output_ / "summary.json");
  const ProgramResult result = Run({});
  ExpectError(result, 2, {output_.string(), "summary.json"});
  EXPECT_EQ(result.errors.find("frame "), std::string::npos) << "no frame is tracked before";
}

TEST_F(RunEnd, TwoRunsAtOnceLeaveTheFilesOfOne) {
  const std::string run = fmt::format("'{}' '{}' --quiet --output '{}'",
                                      ProgramPath("rgbd_tum").string(), path_, output_.string());
  EXPECT_EQ(RunShell(fmt::format("{} --masks '{}' & {}; code=$?; wait $! && exit $code", run,
                                 masks_, run)),
            0);
  const bool has_objects = fs::exists(output_ / "objects.json");
  EXPECT_EQ(Summary()["objects"].is_null(), !has_objects);
  EXPECT_EQ(ReadFolder(output_).size(), Summary()["files"].size() + 1)
      << "the list does not name summary.json";
}

// ---- messages that cannot be written

TEST_F(RunEnd, ARunDoesNotNeedStderr) {
  for (const char* const redirections : {"2>/dev/full >/dev/null", "2>&- >/dev/null"}) {
    EXPECT_EQ(RunWith(redirections), 0) << redirections;
    ExpectResults();
    fs::remove_all(output_);
  }
  RunWith("2>&1 | head -1 >/dev/null");
  ExpectResults();
}

TEST_F(RunEnd, AReportThatCannotBePrintedIsAFailure) {
  for (const char* const redirections : {">/dev/full 2>/dev/null", ">&- 2>/dev/null"}) {
    EXPECT_EQ(RunWith(redirections), 1) << redirections;
    ExpectResults();
    fs::remove_all(output_);
  }
  EXPECT_EQ(RunWith(">/dev/full 2>/dev/null --quiet"), 0) << "nothing is printed";
  for (const char* const program : {"rgbd_tum", "hullslam map-objects", "hullslam check-masks",
                                    "make_synthetic", "hullslam evaluate"}) {
    EXPECT_EQ(RunShell(ProgramFolder().string() + "/" + program + " --help >/dev/full 2>/dev/null"),
              1)
        << program;
  }
}

TEST(Programs, HelpNamesTheExitCodes) {
  for (const char* const program : {"rgbd_tum", "hullslam map-objects", "hullslam check-masks",
                                    "make_synthetic", "hullslam evaluate"}) {
    const ProgramResult help = RunProgram(program, {"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.output.find("Exit codes: 0 "), std::string::npos) << program;
  }
  for (const char* const command : {"trajectory", "objects"}) {
    const ProgramResult help = RunProgram("hullslam evaluate", {command, "--help"});
    EXPECT_NE(help.output.find("Exit codes: 0 "), std::string::npos) << command;
  }
}

// A run may be watched through a pipe or a file.
TEST_F(RunEnd, LinesAreWrittenWhenTheyArePrinted) {
  const PlaneSequence slow(3, 1000.0);
  RunningProgram program("rgbd_tum", {slow.path(), "--realtime", "--output", output_});
  EXPECT_FALSE(program.ReadLine("settings: ").empty());  // while it waits for its second frame
  program.Send(SIGTERM);
  EXPECT_EQ(program.Wait(), 1);
}

// ---- signals

TEST_F(RunEnd, AnInterruptWritesTheResultsSoFar) {
  const PlaneSequence slow(12, 0.5);
  for (const Arguments& more : {Arguments{}, Arguments{"--threaded"}}) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      Arguments arguments = {slow.path(), "--realtime", "--output", output_};
      arguments.insert(arguments.end(), more.begin(), more.end());
      RunningProgram program("rgbd_tum", arguments);
      ASSERT_FALSE(program.ReadLine("frame ").empty());
      // Several signals, as from an impatient user: none may destroy the results.
      for (int i = 0; i < 5; ++i) {
        program.Send(signal);
        ::usleep(2000);
      }
      EXPECT_EQ(program.Wait(), 1);
      const Trajectory poses = ReadTrajectory(output_ / "trajectory.txt");
      ASSERT_GE(poses.size(), 1U);
      EXPECT_LT(poses.size(), 12U);
      for (size_t i = 0; i < poses.size(); ++i) {
        EXPECT_NEAR(poses[i].timestamp, slow.Stamp(static_cast<int>(i)), 1e-6);
        EXPECT_NEAR(poses[i].world_from_cam.translation.x(), 0.01 * static_cast<double>(i), 0.003);
      }
      EXPECT_EQ(Summary()["trajectory"]["frames"], poses.size());
      EXPECT_NEAR(Summary()["trajectory"]["coverage"].get<double>(),
                  static_cast<double>(poses.size()) / 12.0, 1e-9);
      EXPECT_EQ(Summary()["provenance"]["interrupted"], true);
      EXPECT_EQ(ReadFolder(output_).size(), 5U);
    }
  }
}

TEST_F(RunEnd, AnInterruptDoesNotWaitForTheNextFrame) {
  const PlaneSequence slow(3, 1000.0);
  RunningProgram program("rgbd_tum", {slow.path(), "--realtime", "--output", output_});
  ASSERT_FALSE(program.ReadLine("frame ").empty());
  program.Send(SIGTERM);
  EXPECT_EQ(program.Wait(), 1);  // the test's time limit is shorter than the time to the next frame
  EXPECT_EQ(Summary()["trajectory"]["frames"], 1);
}

TEST_F(RunEnd, AnIgnoredSignalStaysIgnored) {
  const PlaneSequence slow(12, 0.2);
  for (const int signal : {SIGINT, SIGHUP}) {
    RunningProgram program("rgbd_tum", {slow.path(), "--realtime", "--output", output_}, signal);
    ASSERT_FALSE(program.ReadLine("frame ").empty());
    program.Send(signal);
    EXPECT_EQ(program.Wait(), 0);
    EXPECT_EQ(Summary()["trajectory"]["tracked"], 12);
    EXPECT_EQ(Summary()["provenance"]["interrupted"], false);
  }
}

TEST_F(RunEnd, AnInterruptedRendererWritesNothing) {
  for (const int signal : {SIGINT, SIGHUP}) {
    RunningProgram program("make_synthetic", {output_, "--frames", "2000"});
    ASSERT_FALSE(program.ReadLine().empty());
    program.Send(signal);
    EXPECT_EQ(program.Wait(), 1);
    EXPECT_FALSE(fs::exists(output_));
  }
}

// ---- lost frames

// Writes an association file, black.txt, with 27 frames, of which those from 6 to 21 are black. The
// frames after the black ones repeat those before, so tracking recovers.
void Blacken(const PlaneSequence& sequence) {
  cv::imwrite(sequence.path() / "rgb/black.png", cv::Mat(480, 640, CV_8UC1, cv::Scalar(0)));
  std::string pairs;
  for (int i = 0; i < 27; ++i) {
    const std::string stamp = fmt::format("{:.6f}", 1000.0 + 0.03 * i);
    const std::string name = i >= 6 && i < 22 ? "black" : fmt::format("{:02}", std::min(i, 5));
    pairs += fmt::format("{} rgb/{}.png {} depth/00.png\n", stamp, name, stamp);
  }
  std::ofstream(sequence.path() / "black.txt") << pairs;
}

TEST_F(RunEnd, TooManyLostFramesAreAFailure) {
  Blacken(sequence_);
  const std::string pairs = path_ + "/black.txt";
  ExpectError(Run({"--associations", pairs}), 1,
              {"error: too many frames were lost: 11 of 27", "run.max_lost_share 0.1"});
  EXPECT_EQ(Summary()["trajectory"]["lost"], 16);
  EXPECT_NEAR(Summary()["trajectory"]["coverage"].get<double>(), 11.0 / 27.0, 1e-9);
  EXPECT_EQ(Run({"--associations", pairs, "--set", "run.max_lost_share=0.6"}).exit_code, 0);
  const Arguments until_lost = {"--associations",        pairs, "--last", "21", "--set",
                                "run.max_lost_share=0.8"};
  EXPECT_EQ(Run(until_lost).exit_code, 0) << "less than a second is lost at the end";
  Arguments strict = until_lost;
  strict.insert(strict.end(), {"--set", "run.max_lost_at_end=0.4"});
  ExpectError(Run(strict), 1, {"did not recover", "6 of 22", "run.max_lost_at_end 0.4"});
}

// ---- messages

// Names of files and classes may come from strangers. They must not control the terminal, and no
// name can begin a line of its own.
TEST_F(RunEnd, MessagesHaveNoControlCharacters) {
  const auto expect_clean = [](const std::string& text) {
    EXPECT_EQ(text.find_first_of("\x1b\x07\r"), std::string::npos) << text;
    EXPECT_EQ(text.find("\nforged"), std::string::npos) << text;
  };
  const std::string name = "no\x1b[2J\nforged";
  const ProgramResult missing = RunProgram("rgbd_tum", {name});
  ExpectError(missing, 2, {"error: ", "no?[2J?forged"});
  expect_clean(missing.errors);
  std::string classes;
  for (int i = 0; i < 41; ++i) {
    classes += "other\n";
  }
  folder_.Write("masks/classes.txt", classes + "cup\x1b]0;x\x07\rforged\n");
  const ProgramResult masks = RunProgram("hullslam check-masks", {path_, masks_, "--quiet"});
  EXPECT_NE(masks.output.find("cup?]0;x??forged"), std::string::npos) << masks.output;
  expect_clean(masks.output);
  const ProgramResult run = Run({"--masks", masks_, "--debug"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  expect_clean(run.output + run.errors);
}

// ---- input that is probably not what the user meant

TEST_F(RunEnd, DoubtfulInputIsReported) {
  ExpectError(Run({"--last", "100", "--quiet"}), 0, {"warning: --last is '100'", "11"});
  ExpectError(Run({"--set", "DepthMapFactor=250000", "--quiet", "--set", "run.max_lost_share=1"}),
              0, {"warning: ", "0.02 m", "DepthMapFactor"});
  ExpectError(Run({"--set", "DepthMapFactor=100", "--quiet", "--set", "run.max_lost_share=1"}), 0,
              {"warning: ", "50 m", "DepthMapFactor"});
  const std::string classes = "tracking.dynamic_classes=persn, person";
  ExpectError(Run({"--masks", masks_, "--set", classes, "--quiet"}), 0,
              {"warning: ", "'persn'", "cup"});
  ExpectError(Run({"--set", classes, "--quiet"}), 0, {"'persn'", "no masks"});
  const fs::path poses = sequence_.path() / "groundtruth.txt";
  ExpectError(Run({"--poses", poses, "--masks", masks_, "--quiet", "--set", classes, "--set",
                   "DepthMapFactor=250000", "--overwrite"},
                  "hullslam map-objects"),
              0, {"'persn'", "0.02 m"});
}

TEST_F(RunEnd, OrdinaryInputGivesNoWarnings) {
  EXPECT_EQ(Run({"--quiet", "--masks", masks_, "--last", "11"}).errors, "");
  EXPECT_EQ(Run({"--quiet", "--masks", masks_, "--set", "tracking.dynamic_classes=cup"}).errors,
            "");
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/suite_writer.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "files/read_file.h"
#include "hullslam/sequences/icl_sequence.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/util/error.h"
#include "results/true_object_file.h"
#include "support/temporary_folder.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

bool Continue(std::string_view, int) { return true; }

std::map<std::string, std::string> FilesBelow(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).string()] = ReadFile(entry.path());
    }
  }
  return files;
}

class SuiteWriter : public ::testing::Test {
 protected:
  fs::path Write(const SuiteOptions& options, const std::string& name = "out") const {
    EXPECT_TRUE(WriteSuite(root_.path() / name, options, Continue));
    return root_.path() / name;
  }
  std::string Message(const SuiteOptions& options) const {
    try {
      WriteSuite(root_.path() / "out", options, Continue);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder root_;
};

// One sequence of each kind: of both forms, with a moving object, with a rolling shutter.
TEST_F(SuiteWriter, SuiteJsonListsTheSequencesWithTheirFiles) {
  const std::vector<std::string> names = {"desk1", "person", "icl0"};
  const std::vector<const SuiteSequence*> sequences = SelectSuite(names);
  const fs::path folder = Write({.frames = 2, .seed = 5, .only = names});
  const auto suite = nlohmann::json::parse(ReadFile(folder / "suite.json"));
  EXPECT_EQ(suite["seed"], 5);
  EXPECT_EQ(suite["frames"], 2);
  ASSERT_EQ(suite["sequences"].size(), sequences.size());
  size_t index = 0;
  for (const auto& entry : suite["sequences"]) {
    const SuiteSequence& sequence = *sequences[index++];
    EXPECT_EQ(entry["name"], sequence.name);
    EXPECT_EQ(entry["plays"], sequence.plays);
    EXPECT_EQ(entry["special"], sequence.special);
    EXPECT_EQ(entry["readout_time"], sequence.readout_time);
    const bool is_icl = entry["dataset"] == "icl";
    EXPECT_EQ(is_icl, sequence.form == DatasetForm::kIcl);
    const fs::path at = folder / entry["folder"];
    EXPECT_TRUE(fs::exists(at / (is_icl ? "associations.txt" : "rgb.txt"))) << entry;
    EXPECT_EQ(fs::exists(at / "rgb.txt"), !is_icl);
    EXPECT_TRUE(fs::exists(folder / entry["masks"] / (is_icl ? "1.txt" : "1000.033333.txt")));
    EXPECT_FALSE(ReadTrueScene(folder / entry["objects"]).objects.empty());
    EXPECT_EQ(OpenTumSequence(folder / entry["tum_folder"]).frames.size(), 2U);
  }
}

TEST_F(SuiteWriter, TheSameSeedGivesTheSameBytesWithAnyNumberOfThreads) {
  const SuiteOptions options{.frames = 2, .seed = 3, .only = {"teddy", "icl1"}, .threads = 1};
  SuiteOptions two = options;
  two.threads = 3;
  SuiteOptions other = options;
  other.seed = 4;
  const auto files = FilesBelow(Write(options, "one"));
  EXPECT_EQ(files, FilesBelow(Write(two, "two")));
  const auto other_files = FilesBelow(Write(other, "other"));
  ASSERT_EQ(files.size(), other_files.size());
  EXPECT_EQ(files.size(), 1U + (3U * 2U + 5U) + (3U * 2U + 7U));
  for (const char* const name :
       {"teddy/rgb/1000.000000.png", "teddy/depth/1000.000000.png", "teddy/groundtruth.txt",
        "icl1/rgb/0.png", "icl1/depth/0.png", "icl1/icl1.gt.freiburg", "icl1/tum/masks/1.txt"}) {
    EXPECT_NE(files.at(name), other_files.at(name)) << name;
  }
  EXPECT_EQ(files.at("icl1/associations.txt"), other_files.at("icl1/associations.txt"));
}

// The reader of ICL-NUIM finds the poses of the plan in the mirrored ground truth.
TEST_F(SuiteWriter, IclNuimComesBackAsItWasPlanned) {
  const int frames = 20;
  const fs::path folder = Write({.frames = frames, .seed = 2, .only = {"icl0"}}) / "icl0";
  const SequencePlan plan =
      PlanOf(*SelectSuite(std::vector<std::string>{"icl0"}).front(), frames, 2);
  EXPECT_EQ(ReadFile(folder / "associations.txt").substr(0, 50),
            "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.pn");
  const IclSequence sequence = OpenIclSequence(folder, plan.camera, {});
  EXPECT_EQ(sequence.package, IclPackage::kTum);
  EXPECT_NE(sequence.groundtruth_note.find("y up, mirrored"), std::string::npos)
      << sequence.groundtruth_note;
  ASSERT_EQ(sequence.images.frames.size(), static_cast<size_t>(frames));
  EXPECT_EQ(sequence.images.frames.front().timestamp, 0.0);
  const Trajectory& truth = *sequence.images.converted_groundtruth;
  ASSERT_EQ(truth.size(), static_cast<size_t>(frames) - 1U) << "the first image has no true pose";
  for (int i = 1; i < frames; ++i) {
    const StampedPose& pose = truth[static_cast<size_t>(i) - 1];
    EXPECT_NEAR(pose.timestamp, i / 30.0, 1e-9);
    const Rigid3 error = Inverse(plan.scene.world_from_cam(i / 30.0)) * pose.world_from_cam;
    EXPECT_LT(error.translation.norm(), 1e-8);
    EXPECT_LT(LogSo3(error.rotation).norm(), 1e-7);
  }
  const cv::Mat depth = cv::imread((folder / "depth/7.png").string(), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(depth.type(), CV_16UC1);
  EXPECT_GT(cv::countNonZero(depth), 640 * 480 * 99 / 100);
}

TEST_F(SuiteWriter, ASuiteIsOnlyReplacedWithForceAndOtherFilesNever) {
  const SuiteOptions options{.frames = 2, .only = {"desk2", "icl3"}};
  const fs::path out = Write(options);
  EXPECT_NE(Message(options).find("already contains a suite; --force"), std::string::npos);
  SuiteOptions force = options;
  force.force = true;
  force.only = {"icl3"};
  EXPECT_EQ(Message(force), "");
  EXPECT_FALSE(fs::exists(out / "desk2"));
  for (const char* const name : {"thesis.txt", "icl3/thesis.txt", "icl3/desk2.gt.freiburg"}) {
    std::ofstream(out / name) << "precious";
    EXPECT_NE(Message(force).find("is not (only) a suite"), std::string::npos) << name;
    EXPECT_EQ(ReadFile(out / name), "precious");
    fs::remove(out / name);
  }
  fs::create_directory(out / "holidays");
  EXPECT_NE(Message(force).find("is not (only) a suite"), std::string::npos);
  fs::remove(out / "holidays");
  std::ofstream(out / "suite.json") << "{broken";
  EXPECT_NE(Message(force).find("is not (only) a suite"), std::string::npos);
}

TEST_F(SuiteWriter, AnUnknownNameOrACancelledCallLeavesNothing) {
  EXPECT_NE(Message({.frames = 2, .only = {"desk3"}}).find("desk1, desk2"), std::string::npos);
  int calls = 0;
  EXPECT_FALSE(WriteSuite(root_.path() / "out", {.frames = 2, .only = {"desk2", "icl3"}},
                          [&](std::string_view name, int done) {
                            EXPECT_EQ(name, done <= 2 ? "desk2" : "icl3");
                            return ++calls < 3;
                          }));
  EXPECT_TRUE(fs::is_empty(root_.path()));
}

}  // namespace
}  // namespace hullslam::synthetic

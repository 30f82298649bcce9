// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/finished_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "hullslam/results/trajectory_file.h"
#include "results/ply_file.h"
#include "results/summary.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// The folder of a run with no file but summary.json.
class FinishedRunTest : public ::testing::Test {
 protected:
  FinishedRunTest() {
    summary_.trajectory.alignment = "sim3";
    summary_.map.keyframes = 12;
    summary_.map.landmarks = 345;
    summary_.provenance.program = "mono_bag";
    summary_.provenance.version = "1.2.3";
    summary_.provenance.sequence = "data/walk.mcap";
    summary_.provenance.dataset = "bag";
    summary_.provenance.sequence_choices = {{"image_topic", "/left"}};
    summary_.provenance.masks = "masks";
    summary_.provenance.masks_format = "coco";
    summary_.provenance.map = "walk.map";
  }
  FinishedRun Open() const {
    folder_.Write("a/run/summary.json", FormatSummary(summary_));
    return OpenFinishedRun(run_);
  }

  TemporaryFolder folder_;
  fs::path run_ = folder_.path() / "a/run";
  RunSummary summary_;
};

TEST_F(FinishedRunTest, HasWhatTheSummarySays) {
  const FinishedRun run = Open();
  EXPECT_EQ(run.program, "mono_bag");
  EXPECT_EQ(run.version, "1.2.3");
  EXPECT_EQ(run.alignment, AlignmentKind::kSim3);
  EXPECT_FALSE(run.IsMetric());
  EXPECT_EQ(run.sequence.path, "data/walk.mcap");
  EXPECT_EQ(run.sequence.dataset, "bag");
  EXPECT_EQ(run.sequence.choices, summary_.provenance.sequence_choices);
  EXPECT_EQ(run.masks, "masks");
  EXPECT_EQ(run.masks_format, "coco");
  EXPECT_EQ(run.map, "walk.map");
  EXPECT_EQ(run.keyframes, 12U);
  EXPECT_EQ(run.landmarks, 345U);
  EXPECT_EQ(*run.summary, nlohmann::json::parse(FormatSummary(summary_)));
}

TEST_F(FinishedRunTest, WhatARunDidNotHaveIsEmpty) {
  summary_ = {};
  summary_.trajectory.alignment = "none";
  const FinishedRun run = Open();
  EXPECT_TRUE(run.IsMetric());
  for (const std::string& text :
       {run.program, run.version, run.sequence.path, run.sequence.dataset, run.masks, run.map}) {
    EXPECT_EQ(text, "");
  }
  EXPECT_FALSE(run.ReadLandmarkPoints());
  EXPECT_FALSE(run.ReadObjectResults());
  EXPECT_FALSE(run.ReadSceneGraph());
  EXPECT_FALSE(run.ReadConvertedGroundtruth());
}

TEST_F(FinishedRunTest, ReadsTheFilesOfTheRun) {
  const Trajectory poses = {{1.0, Rigid3()}, {2.0, Rigid3()}};
  folder_.Write("a/run/trajectory.txt", FormatTrajectory(poses));
  folder_.Write("a/run/keyframes.txt", FormatTrajectory({poses[0]}));
  folder_.Write("a/run/groundtruth.txt", FormatTrajectory(poses));
  folder_.Write("a/run/map.ply", FormatMapPly(std::vector<Eigen::Vector3d>{{1.0, 2.0, 3.0}},
                                              std::vector<Eigen::Vector3d>{{0.0, 0.0, 0.0}}));
  const FinishedRun run = Open();
  EXPECT_EQ(run.ReadPoses().size(), 2U);
  EXPECT_EQ(run.ReadKeyframePoses().size(), 1U);
  EXPECT_EQ(run.ReadConvertedGroundtruth()->size(), 2U);
  EXPECT_EQ(run.ReadLandmarkPoints()->positions.size(), 1U) << "without the centre of a keyframe";
  folder_.Write("a/run/objects.json", "{");
  folder_.Write("a/run/scene.json", "{");
  folder_.Write("a/run/map.ply", "ply");
  ExpectInputError([&] { run.ReadObjectResults(); }, {"objects.json"});
  ExpectInputError([&] { run.ReadSceneGraph(); }, {"scene.json"});
  ExpectInputError([&] { run.ReadLandmarkPoints(); }, {"map.ply"});
}

// The files have the poses of the camera as read, which is turned by 90 degrees.
TEST_F(FinishedRunTest, PosesAreThoseOfTheRectifiedCamera) {
  const Rigid3 turned(
      Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitY())),
      {1.0, 2.0, 3.0});
  for (const char* const name : {"trajectory", "keyframes", "groundtruth"}) {
    folder_.Write(fmt::format("a/run/{}.txt", name), FormatTrajectory({{1.0, turned}}));
  }
  summary_.provenance.sequence_choices["rectified_from_left"] = "0 0.707106781 0 0.707106781";
  const FinishedRun run = Open();
  for (const Trajectory& poses :
       {run.ReadPoses(), run.ReadKeyframePoses(), run.ReadConvertedGroundtruth().value()}) {
    const Rigid3& pose = poses[0].world_from_cam;
    EXPECT_LT(pose.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1e-6);
    EXPECT_EQ(pose.translation, Eigen::Vector3d(1.0, 2.0, 3.0));
  }
  EXPECT_GT(run.ReadPosesAsRead()[0].world_from_cam.rotation.angularDistance(
                Eigen::Quaterniond::Identity()),
            1.0);
  summary_.provenance.sequence_choices["rectified_from_left"] = "0 0 x";
  ExpectInputError([&] { Open().ReadPoses(); }, {"rectified_from_left", "'0 0 x'"});
}

TEST_F(FinishedRunTest, FindsInputsInTheFoldersAbove) {
  folder_.Write("data/walk.mcap", "");
  const FinishedRun run = Open();
  EXPECT_EQ(run.Find(run.sequence.path), folder_.path() / "data/walk.mcap");
  EXPECT_EQ(run.Find(folder_.path()), folder_.path());
  EXPECT_FALSE(run.Find("data/desk"));
  EXPECT_FALSE(run.Find(""));
}

TEST_F(FinishedRunTest, ABrokenSummaryIsRefusedWithItsNameAndTheKey) {
  ExpectInputError([&] { OpenFinishedRun(folder_.path()); },
                   {folder_.path(), "has no summary.json"});
  const std::map<std::string, std::string> faults = {
      {"", "JSON"},
      {"[]", "expected"},
      {"{}", "\"trajectory\" is missing"},
      {R"({"trajectory": 3})", "trajectory is 3"},
      {R"({"trajectory": {"alignment": null}})", "trajectory.alignment is null"},
      {R"({"trajectory": {"alignment": "affine"}})",
       "trajectory.alignment is \"affine\", expected none, se3 or sim3"},
      {R"({"trajectory": {"alignment": "se3"}, "map": {"keyframes": -1}})", "map.keyframes is -1"}};
  for (const auto& [text, part] : faults) {
    const std::string path = folder_.Write("a/run/summary.json", text);
    ExpectInputError([&] { OpenFinishedRun(run_); }, {path, part});
  }
  for (const auto& [provenance, part] : std::map<std::string, std::string>{
           {"3", "provenance is 3"},
           {R"({"program": 7})", "provenance.program is 7"},
           {R"({"sequence_choices": [1]})", "provenance.sequence_choices is [1]"},
           {R"({"sequence_choices": {"times": 3}})", "provenance.sequence_choices.times is 3"}}) {
    folder_.Write("a/run/summary.json",
                  R"({"trajectory": {"alignment": "se3"}, "map": {"keyframes": 1, "landmarks": 2},
                      "provenance": )" +
                      provenance + "}");
    ExpectInputError([&] { OpenFinishedRun(run_); }, {"summary.json", part});
  }
}

}  // namespace
}  // namespace hullslam

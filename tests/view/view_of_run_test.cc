// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_of_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "hullslam/results/trajectory_file.h"
#include "results/object_file.h"
#include "results/ply_file.h"
#include "results/scene_file.h"
#include "results/summary.h"
#include "support/expect_error.h"
#include "support/made_view.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// The files of a small run, without a sequence.
class ViewOfRunTest : public ::testing::Test {
 protected:
  ViewOfRunTest() {
    RunSummary summary;
    summary.provenance.program = "rgbd_tum";
    summary.provenance.sequence = "gone/fr1_made/";
    folder_.Write("summary.json", FormatSummary(summary));
    folder_.Write("trajectory.txt", FormatTrajectory(poses_));
    folder_.Write("keyframes.txt", FormatTrajectory({poses_[0], poses_[4]}));
    folder_.Write("groundtruth.txt", FormatTrajectory(poses_));
    const std::vector<Eigen::Vector3d> landmarks = {{0.0, 0.0, 1.0}, {1.0, 0.0, 2.0}};
    const std::vector<Eigen::Vector3d> centres(2, Eigen::Vector3d::Zero());
    folder_.Write("map.ply", FormatMapPly(landmarks, centres));
    ObjectResults report;
    report.sequence = "gone";
    report.camera = MadeCamera();
    report.objects = {MadeSphere(7, "cup")};
    folder_.Write("objects.json", FormatObjects(report));
    folder_.Write("objects_observations.json", FormatObservations(report));
  }
  static Trajectory MakePoses() {
    Trajectory poses;
    for (int i = 0; i < 5; ++i) {
      poses.push_back(
          {1.0 + i, Rigid3(Eigen::Quaterniond::Identity(), {0.3 * i, 0.1 * i * i, 0.0})});
    }
    return poses;
  }
  bool HasNote(const ViewModel& model, const std::string& text) const {
    return std::any_of(model.notes.begin(), model.notes.end(), [&](const std::string& note) {
      return note.find(text) != std::string::npos;
    });
  }

  TemporaryFolder folder_;
  Trajectory poses_ = MakePoses();
};

TEST_F(ViewOfRunTest, ReadsTheFilesOfTheRun) {
  const ViewModel model = ViewOfRun(folder_.path());
  EXPECT_EQ(model.title, "fr1_made");
  EXPECT_EQ(model.program, "rgbd_tum");
  EXPECT_TRUE(model.is_metric);
  EXPECT_EQ(model.trajectory.size(), 5u);
  EXPECT_EQ(model.keyframes.poses.size(), 2u);
  EXPECT_EQ(model.landmarks.positions.size(), 2u);  // without the centres of keyframes
  EXPECT_EQ(model.groundtruth.size(), 5u);
  EXPECT_EQ(model.errors.metres.size(), 5u);
  ASSERT_EQ(model.objects.size(), 1u);
  EXPECT_EQ(model.objects[0].object.id, ObjectId(7));
  EXPECT_TRUE(model.up);
  EXPECT_TRUE(HasNote(model, "\"gone/fr1_made/\" is not found"));
  EXPECT_EQ(model.notes.size(), 1u);
}

TEST_F(ViewOfRunTest, KeyframesOfTwoSessionsAreNoLandmarks) {
  const std::vector<TrajectoryPart> sessions = {{"first", {poses_[3], poses_[4]}},
                                                {"second", {poses_[0], poses_[1]}}};
  folder_.Write("keyframes.txt", FormatTrajectory(sessions));
  const std::vector<Eigen::Vector3d> landmarks = {{0.0, 0.0, 1.0}};
  const std::vector<Eigen::Vector3d> centres(4, Eigen::Vector3d::Zero());
  folder_.Write("map.ply", FormatMapPly(landmarks, centres));
  const ViewModel model = ViewOfRun(folder_.path());
  EXPECT_EQ(model.keyframes.poses.size(), 4u);
  EXPECT_EQ(model.landmarks.positions.size(), 1u);
  EXPECT_FALSE(HasNote(model, "keyframes left out"));
}

TEST_F(ViewOfRunTest, AMonocularRunHasAnUnknownUnit) {
  RunSummary summary;
  summary.trajectory.alignment = "sim3";
  folder_.Write("summary.json", FormatSummary(summary));
  EXPECT_FALSE(ViewOfRun(folder_.path()).is_metric);
}

TEST_F(ViewOfRunTest, RelationsAndBoxesComeFromTheScene) {
  Scene scene;
  scene.up = Eigen::Vector3d::UnitZ();
  scene.objects.resize(2);
  scene.objects[0].id = ObjectId(7);
  scene.objects[1].id = ObjectId(8);
  for (SceneObject& object : scene.objects) {
    object.ellipsoid.half_axes.setConstant(0.1);
  }
  scene.objects[0].box = UprightBox{Rigid3(), {0.1, 0.2, 0.3}};
  scene.relations = {{ObjectId(7), RelationKind::kOn, ObjectId(8), {}}};
  folder_.Write("scene.json", FormatScene(scene));
  const ViewModel model = ViewOfRun(folder_.path());
  EXPECT_TRUE(model.notes.size() == 1u) << model.notes.back();
  EXPECT_EQ(*model.up, Eigen::Vector3d::UnitZ());
  ASSERT_EQ(model.relations.size(), 1u);
  EXPECT_EQ(model.relations[0].kind, RelationKind::kOn);
  ASSERT_FALSE(model.objects.empty());
  ASSERT_TRUE(model.objects[0].body && model.objects[0].body->box);
  EXPECT_EQ(model.objects[0].body->box->half_extents.z(), 0.3);
  folder_.Write("scene.json", R"({"version": 1, "relations": [{"subject": "x"}]})");
  EXPECT_TRUE(HasNote(ViewOfRun(folder_.path()), "relations left out: "));
}

TEST_F(ViewOfRunTest, ABrokenSurfaceIsLeftOutAndNamed) {
  folder_.Write("mesh.ply", "ply\n");
  EXPECT_TRUE(HasNote(ViewOfRun(folder_.path()), "surface left out: "));
}

TEST_F(ViewOfRunTest, BrokenFilesAreLeftOutAndNamed) {
  folder_.Write("trajectory.txt", "1 nan 0 0 0 0 0 1\n");
  folder_.Write("map.ply", "ply\n");
  folder_.Write("objects.json", R"({"version": 1})");
  const ViewModel model = ViewOfRun(folder_.path());
  EXPECT_TRUE(model.trajectory.empty());
  EXPECT_TRUE(model.landmarks.positions.empty());
  EXPECT_TRUE(model.objects.empty());
  EXPECT_EQ(model.keyframes.poses.size(), 2u);
  for (const char* const file : {"trajectory.txt:1", "map.ply", "objects.json: version is 1"}) {
    EXPECT_TRUE(HasNote(model, file)) << file;
  }
}

TEST_F(ViewOfRunTest, AFolderWithoutASummaryIsNoRun) {
  std::filesystem::remove(folder_.path() / "summary.json");
  ExpectInputError([&] { ViewOfRun(folder_.path()); }, {"summary.json"});
  folder_.Write("summary.json", "{\"trajectory\": ");
  ExpectInputError([&] { ViewOfRun(folder_.path()); }, {"summary.json"});
  folder_.Write("summary.json", "[1, 2]");
  ExpectInputError([&] { ViewOfRun(folder_.path()); }, {"summary.json", "expected an object"});
}

TEST_F(ViewOfRunTest, ARunWithoutMapHasTheOtherParts) {
  for (const char* const file : {"map.ply", "objects.json", "keyframes.txt", "groundtruth.txt"}) {
    std::filesystem::remove(folder_.path() / file);
  }
  const ViewModel model = ViewOfRun(folder_.path());
  EXPECT_EQ(model.trajectory.size(), 5u);
  EXPECT_TRUE(model.landmarks.positions.empty());
  EXPECT_TRUE(model.errors.metres.empty());
}

}  // namespace
}  // namespace hullslam

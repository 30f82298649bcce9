// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sequence_files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/util/error.h"
#include "results/true_object_file.h"
#include "support/temporary_folder.h"
#include "synthetic/object_models.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

SequencePlan TwoFrames(DatasetForm form) {
  SequencePlan plan;
  plan.name = "made";
  plan.frames = 2;
  plan.readout_time = form == DatasetForm::kTum ? 0.02 : 0.0;
  plan.layout.form = form;
  plan.scene.world_from_cam = [](double time) {
    return Rigid3{ExpSo3({0.1, 0.2, 0.3}), {1.0 + time, 2.0, 3.0}};
  };
  return plan;
}

TEST(WriteSequenceFiles, ThoseOfTumAreInOneFolder) {
  const TemporaryFolder root;
  WriteSequenceFiles(root.path(), TwoFrames(DatasetForm::kTum));
  EXPECT_EQ(ReadFile(root.path() / "depth.txt"),
            "# timestamp filename\n1000.000000 depth/1000.000000.png\n"
            "1000.033333 depth/1000.033333.png\n");
  EXPECT_NE(ReadFile(root.path() / "camera.yaml").find("Camera.readout_time: 0.02"),
            std::string::npos);
  const Trajectory truth = ReadTrajectory(root.path() / "groundtruth.txt");
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_NEAR(truth[1].world_from_cam.translation.x(), 1.0 + 1.0 / 30.0, 1e-8);
}

// With F = diag(1, -1, 1), the poses of ICL-NUIM are F R F and F t.
TEST(WriteSequenceFiles, IclHasAMirroredGroundTruthFromIndexOneAndAFolderForOthers) {
  const TemporaryFolder root;
  fs::create_directory(root.path() / "tum");
  const SequencePlan plan = TwoFrames(DatasetForm::kIcl);
  WriteSequenceFiles(root.path(), plan);
  EXPECT_EQ(ReadFile(root.path() / "associations.txt"),
            "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n");
  EXPECT_EQ(ReadFile(root.path() / "tum/rgb.txt"),
            "# timestamp filename\n0.000000 ../rgb/0.png\n0.033333 ../rgb/1.png\n");
  const Trajectory mirrored = ReadTrajectory(root.path() / "made.gt.freiburg");
  const Trajectory truth = ReadTrajectory(root.path() / "tum/groundtruth.txt");
  ASSERT_EQ(mirrored.size(), 1U);
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_EQ(mirrored[0].timestamp, 1.0);
  const Eigen::Vector3d flip(1.0, -1.0, 1.0);
  const Rigid3& given = mirrored[0].world_from_cam;
  const Rigid3& right = truth[1].world_from_cam;
  EXPECT_TRUE(given.translation.isApprox(flip.cwiseProduct(right.translation), 1e-8));
  const Eigen::Matrix3d expected =
      flip.asDiagonal() * right.rotation.toRotationMatrix() * flip.asDiagonal();
  EXPECT_TRUE(given.rotation.toRotationMatrix().isApprox(expected, 1e-7));
}

TEST(WriteSequenceFiles, SaysWhichObjectsAreRoundAndHowManyMasksShowThem) {
  const TemporaryFolder root;
  SequencePlan plan = TwoFrames(DatasetForm::kTum);
  for (const ObjectBuilder& model :
       {MakeBottle({}, {}), MakeMug({}), MakeSolid("cup", Shape::Cylinder(0.1, 0.2), {}),
        MakeSolid("bowl", Shape::Superquadric({0.1, 0.1, 0.05}, 0.6, 1.0), {}),
        MakeSolid("vase", Shape::Superquadric({0.1, 0.1, 0.05}, 0.6, 0.6), {}),
        MakeSolid("apple", Shape::Ellipsoid({0.1, 0.2, 0.1}), {})}) {
    plan.scene.objects.push_back(model.Build({1.0, 2.0, 0.0}, 0.5));
    plan.scene.objects.back().id = static_cast<int>(plan.scene.objects.size());
  }
  WriteSequenceFiles(root.path(), plan, {0, 1, 2, 3, 4, 5});
  const std::vector<TrueObject> objects =
      ReadTrueScene(root.path() / "groundtruth_objects.json").objects;
  ASSERT_EQ(objects.size(), 6U);
  const std::vector<bool> is_round = {true, false, true, true, false, false};
  for (size_t i = 0; i < objects.size(); ++i) {
    EXPECT_EQ(objects[i].is_round, is_round[i]) << objects[i].label;
    EXPECT_EQ(objects[i].masks, i);
  }
  EXPECT_EQ(objects[2].shape, "cylinder");
  WriteSequenceFiles(root.path(), plan);
  EXPECT_FALSE(
      ReadTrueScene(root.path() / "groundtruth_objects.json").objects[0].masks.has_value());
}

TEST(WriteNewFile, SaysWhichFileCannotBeWritten) {
  const TemporaryFolder root;
  const fs::path path = root.path() / "none" / "file";
  try {
    WriteNewFile(path, "x");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
  }
}

}  // namespace
}  // namespace hullslam::synthetic

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/make_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "support/drawn_depth.h"
#include "support/expect_error.h"
#include "support/fisheye_camera.h"
#include "support/plane_sequence.h"
#include "support/square_mask.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// ---- the view of a depth image

TEST(MakeMesh, RaysShowTheirPixels) {
  const PinholeCamera camera = FisheyeCamera();
  cv::Mat seen;
  const cv::Mat rays = RaysOf(camera, seen);
  for (const Eigen::Vector2d& raw : std::vector<Eigen::Vector2d>{{10, 20}, {300, 200}, {0, 0}}) {
    const int x = static_cast<int>(raw.x());
    const int y = static_cast<int>(raw.y());
    EXPECT_EQ(seen.at<uint8_t>(y, x) != 0, camera.SeesRaw(raw));
    if (camera.SeesRaw(raw)) {
      const auto& ray = rays.at<cv::Vec2f>(y, x);
      const Eigen::Vector3d point = Eigen::Vector3f(ray[0], ray[1], 1.0F).cast<double>();
      EXPECT_LT((camera.Distort(camera.Project(point)) - raw).norm(), 1e-3);
    }
  }
}

TEST(MakeMesh, RowsHavePosesOnlyWithARollingShutter) {
  SystemOptions options = SmallCameraOptions();
  const Rigid3 pose(ExpSo3({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0});
  const PointVelocity velocity{{0.0, 0.0, 1.0}, {2.0, 0.0, 0.0}};
  EXPECT_EQ(PosesOfRows(options, pose, velocity).size(), 1U);
  options.readout_time = 0.1;
  const std::vector<Rigid3> rows = PosesOfRows(options, pose, velocity);
  ASSERT_EQ(rows.size(), 120U);
  EXPECT_LT((rows[60].translation - pose.translation).norm(), 1e-12);
  const Rigid3 top_from_middle = rows[0] * Inverse(pose);
  EXPECT_LT((LogSo3(top_from_middle.rotation) - Eigen::Vector3d(0, 0, -0.05)).norm(), 1e-9);
  EXPECT_LT((top_from_middle.translation - Eigen::Vector3d(-0.1, 0, 0)).norm(), 1e-9);
  options.readout_direction = ReadoutDirection::kColumns;
  EXPECT_EQ(PosesOfRows(options, pose, velocity).size(), 160U);
  options.tracking.correct_shutter = false;
  EXPECT_EQ(PosesOfRows(options, pose, velocity).size(), 1U);
}

DepthView ViewOf(const cv::Mat& depth, double max_depth = 10.0) {
  const SystemOptions options = SmallCameraOptions();
  cv::Mat seen;
  SerialRunner runner;
  return MakeDepthView(depth, options, max_depth, RaysOf(options.camera, seen), runner);
}

cv::Mat Wall(double z) { return {120, 160, CV_32FC1, cv::Scalar(z)}; }

TEST(MakeMesh, WeightsAreThoseOfTheDepthError) {
  const DepthView near = ViewOf(Wall(1.0));
  const DepthView far = ViewOf(Wall(2.0));
  const double sigma = SystemOptions().depth.error.disparity_sigma / 12.0;  // m at 1 m
  EXPECT_NEAR(near.weight.at<float>(60, 80), 1.0 / (sigma * sigma), 0.01);
  EXPECT_NEAR(near.weight.at<float>(60, 80) / far.weight.at<float>(60, 80), 16.0, 0.01);
  EXPECT_NEAR(near.cosine.at<float>(60, 80), 1.0, 1e-3);
  // 45 degrees at the border of the image would be 80 px from the centre.
  EXPECT_NEAR(near.cosine.at<float>(60, 140), std::cos(std::atan(60.5 / 160.0)), 1e-3);
}

TEST(MakeMesh, BordersGrazingAnglesAndFarDepthsAreNotUsed) {
  cv::Mat depth = Wall(2.0);
  depth(cv::Rect(60, 40, 40, 40)) = 1.0;
  depth.at<float>(20, 20) = 0.0F;
  const DepthView view = ViewOf(depth);
  const auto is_used = [&](int x, int y) { return view.weight.at<float>(y, x) > 0.0F; };
  EXPECT_TRUE(is_used(80, 60));
  EXPECT_TRUE(is_used(40, 60));
  for (const int x : {58, 59, 60, 61, 98, 99, 100, 101}) {
    EXPECT_FALSE(is_used(x, 60)) << x;
  }
  EXPECT_FALSE(is_used(20, 20));
  EXPECT_FALSE(is_used(21, 20)) << "beside an unknown depth";
  EXPECT_FALSE(is_used(1, 60)) << "at the border of the image";
  EXPECT_EQ(cv::countNonZero(ViewOf(depth, 1.5).weight), 36 * 36);
  const SystemOptions options = SmallCameraOptions();
  // A floor 0.1 m below the camera: at 0.5 m it is seen at 11 degrees, at 0.8 m at 7 degrees.
  const DepthView floor = DrawView(options, {Rigid3()}, PlaneAt(Eigen::Vector3d::UnitY(), 0.1));
  EXPECT_GT(floor.weight.at<float>(100, 80), 0.0F);
  EXPECT_EQ(floor.weight.at<float>(76, 80), 0.0F);
}

// ---- a mesh of a plane at z = 1 m, which a camera passes in 1 cm per frame

class OneClass : public MaskSource {
 public:
  explicit OneClass(std::string label) : label_(std::move(label)) {}
  std::string format() const override { return "test"; }
  bool Contains(const MaskFrame& /*frame*/) const override { return true; }
  std::string Example() const override { return ""; }
  FrameMasks Read(const MaskFrame& /*frame*/) const override {
    return {.masks = {Square(label_, 0.0, 0.0, 320.0)}, .rows = {0}};
  }

 private:
  std::string label_;
};

class MakePlane : public ::testing::Test {
 protected:
  MakePlane() {
    input_.options = ReadSettings(plane_.path() / "camera.yaml");
    input_.sequence = OpenTumSequence(plane_.path());
    input_.poses = ReadTrajectory(plane_.path() / "groundtruth.txt");
    input_.keyframes = {plane_.Stamp(0), plane_.Stamp(3)};
  }

  std::optional<Mesh> Make() {
    SerialRunner runner;
    return MakeMesh(input_, options_, runner, [&](size_t done, size_t all) {
      done_ = done;
      all_ = all;
      return go_on_;
    });
  }

  PlaneSequence plane_{6};
  MeshInput input_;
  MeshOptions options_;
  bool go_on_ = true;
  size_t done_ = 0;
  size_t all_ = 0;
};

TEST_F(MakePlane, IsWhereTheDepthsAre) {
  const Mesh mesh = Make().value();
  EXPECT_EQ(mesh.views, 2U);
  EXPECT_EQ(all_, 2U);
  EXPECT_EQ(done_, 2U);
  EXPECT_NEAR(mesh.voxel, 0.007, 1e-12) << "a 150th of the depth";
  EXPECT_NEAR(mesh.truncation, 0.028, 1e-12);
  EXPECT_NEAR(mesh.max_depth, 3.2, 1e-9) << "ThDepth times the baseline";
  EXPECT_TRUE(mesh.objects.empty());
  ASSERT_GT(mesh.scene.positions.size(), 20'000U);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& position : mesh.scene.positions) {
    EXPECT_NEAR(position.z(), 1.0F, 1e-4F);
    box.extend(position);
  }
  EXPECT_NEAR(box.sizes().x(), 636.0 / 500.0 + 0.03, 0.025);
  EXPECT_NEAR(box.sizes().y(), 476.0 / 500.0, 0.025);
}

// 3.2 m is the default; the plane is at 1 m, so a limit below it leaves nothing.
TEST_F(MakePlane, TakesTheOptions) {
  options_ = {.voxel = 0.02, .max_depth = 1.2, .every = 2};
  const Mesh mesh = Make().value();
  EXPECT_EQ(mesh.views, 3U);
  EXPECT_EQ(mesh.voxel, 0.02);
  EXPECT_EQ(mesh.max_depth, 1.2);
  options_ = {.max_depth = 0.9};
  ExpectInputError([&] { Make(); }, {"0.9 m", "--max-depth"});
  options_ = {.voxel = 0.0005};
  ExpectInputError([&] { Make(); }, {"0.0005 m", "blocks", "--voxel"});
}

TEST_F(MakePlane, DisparityOffsetIsTakenAway) {
  input_.options.depth.disparity_offset = 1.0;  // of 40 px at 1 m
  const Mesh mesh = Make().value();
  EXPECT_NEAR(mesh.scene.positions.at(1000).z(), 40.0 / 39.0, 1e-3);
}

TEST_F(MakePlane, MovingThingsAreLeftOut) {
  const size_t all = Make()->scene.positions.size();
  input_.masks = std::make_unique<OneClass>("cup");
  EXPECT_EQ(Make()->scene.positions.size(), all);
  input_.masks = std::make_unique<OneClass>("person");
  const Mesh without = Make().value();
  EXPECT_LT(without.scene.positions.size(), 0.7 * static_cast<double>(all));
  for (const Eigen::Vector3f& position : without.scene.positions) {
    EXPECT_TRUE(position.x() > -0.05F || position.y() > 0.1F) << position.transpose();
  }
}

TEST_F(MakePlane, ObjectsHaveMeshesOfTheirOwn) {
  ObjectResult object;
  object.id = ObjectId(7);
  object.label = "book";
  object.state = ObjectState::kMapped;
  object.ellipsoid = {Rigid3(Eigen::Quaterniond::Identity(), {0.1, 0.0, 1.0}), {0.2, 0.2, 0.05}};
  ObservationResult seen;
  seen.timestamp = plane_.Stamp(0);
  seen.contour = {{319.5, 189.5}, {419.5, 189.5}, {419.5, 289.5}, {319.5, 289.5}};
  object.observations = {seen};
  input_.objects = {object};
  const Mesh mesh = Make().value();
  ASSERT_EQ(mesh.objects.size(), 1U);
  EXPECT_EQ(mesh.objects[0].id, ObjectId(7));
  EXPECT_EQ(mesh.objects[0].label, "book");
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& position : mesh.objects[0].surface.positions) {
    box.extend(position);
  }
  // The contour is a square of 0.2 m; the ellipsoid is larger.
  EXPECT_LT((box.min() - Eigen::Vector3f(0.0F, -0.1F, 1.0F)).norm(), 0.02F);
  EXPECT_LT((box.max() - Eigen::Vector3f(0.2F, 0.1F, 1.0F)).norm(), 0.02F);
  input_.objects[0].ellipsoid.half_axes = {0.05, 0.05, 0.05};
  EXPECT_LT(Make()->objects.at(0).surface.positions.size(),
            mesh.objects[0].surface.positions.size() / 2);
}

TEST_F(MakePlane, CanBeStopped) {
  go_on_ = false;
  EXPECT_FALSE(Make());
  EXPECT_EQ(done_, 1U);
}

TEST_F(MakePlane, ThreadsGiveTheSameBits) {
  const Mesh one = Make().value();
  ParallelRunner runner(3);
  const Mesh other =
      MakeMesh(input_, options_, runner, [](size_t, size_t) { return true; }).value();
  EXPECT_EQ(one.scene.positions, other.scene.positions);
  EXPECT_EQ(one.scene.colours, other.scene.colours);
  EXPECT_EQ(one.scene.triangles, other.scene.triangles);
}

TEST_F(MakePlane, FramesOfAnotherSequenceAreRefused) {
  for (StampedPose& pose : input_.poses) {
    pose.timestamp += 1e4;
  }
  ExpectInputError([&] { Make(); }, {"6 poses, 2 keyframes", "expected the sequence of the run"});
}

// ---- opening a run

class OpenMesh : public ::testing::Test {
 protected:
  // Writes a run of the sequence. `alignment` is that of its summary.
  std::filesystem::path WriteRun(const std::string& sequence, const std::string& alignment) {
    folder_.Write("run/summary.json",
                  R"({"trajectory": {"alignment": ")" + alignment +
                      R"("}, "map": {"keyframes": 1, "landmarks": 1}, "provenance": {"program": )"
                      R"("rgbd_tum", "dataset": "tum", "sequence": ")" +
                      sequence + "\"}}");
    const Trajectory truth = ReadTrajectory(plane_.path() / "groundtruth.txt");
    folder_.Write("run/trajectory.txt", FormatTrajectory(truth));
    folder_.Write("run/keyframes.txt", FormatTrajectory({truth[0], truth[2]}));
    return folder_.path() / "run";
  }

  PlaneSequence plane_{4};
  TemporaryFolder folder_;
};

TEST_F(OpenMesh, ReadsWhatTheRunHasWritten) {
  const std::filesystem::path run = WriteRun(plane_.path(), "se3");
  ExpectInputError([&] { OpenMeshInput({.input = run}); }, {"settings.yaml", "--settings FILE"});
  EXPECT_EQ(
      OpenMeshInput({.input = run, .settings = plane_.path() / "camera.yaml"}).options.camera.fx,
      500.0);
  folder_.Write("run/settings.yaml", FormatSettings(ReadSettings(plane_.path() / "camera.yaml")));
  const MeshInput input = OpenMeshInput({.input = run});
  EXPECT_EQ(input.poses.size(), 4U);
  EXPECT_EQ(input.keyframes.size(), 2U);
  EXPECT_EQ(input.sequence.frames.size(), 4U);
  EXPECT_EQ(HashSettings(input.options), HashSettings(ReadSettings(plane_.path() / "camera.yaml")));
  EXPECT_EQ(OpenMeshInput({.input = run, .overrides = {"DepthMapFactor=1000"}})
                .options.depth.units_per_metre,
            1000.0);
}

TEST_F(OpenMesh, ExplainsWhatIsMissing) {
  ExpectInputError([&] { OpenMeshInput({.input = folder_.path() / "none"}); },
                   {"none", "does not exist"});
  ExpectInputError([&] { OpenMeshInput({.input = folder_.path()}); }, {"summary.json"});
  const std::filesystem::path file = folder_.Write("not.map", "text");
  ExpectInputError([&] { OpenMeshInput({.input = file}); }, {"not.map", "--sequence PATH"});
  ExpectInputError([&] { OpenMeshInput({.input = file, .sequence = plane_.path()}); }, {"not.map"});
  const std::filesystem::path run = WriteRun("/gone", "sim3");
  folder_.Write("run/settings.yaml", FormatSettings(ReadSettings(plane_.path() / "camera.yaml")));
  ExpectInputError([&] { OpenMeshInput({.input = run}); }, {"monocular", "stereo"});
  WriteRun("/gone", "se3");
  ExpectInputError([&] { OpenMeshInput({.input = run}); }, {"'/gone'", "--sequence PATH"});
  EXPECT_EQ(OpenMeshInput({.input = run, .sequence = plane_.path()}).poses.size(), 4U);
  std::filesystem::remove_all(plane_.path() / "depth");
  std::filesystem::remove(plane_.path() / "depth.txt");
  EXPECT_THROW(OpenMeshInput({.input = run, .sequence = plane_.path()}), InputError);
}

}  // namespace
}  // namespace hullslam

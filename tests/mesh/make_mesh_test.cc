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
#include "support/expect_error.h"
#include "support/plane_sequence.h"
#include "support/square_mask.h"

namespace hullslam {
namespace {

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

// A plane at z = 1 m, which a camera passes in 1 cm per frame.
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

}  // namespace
}  // namespace hullslam

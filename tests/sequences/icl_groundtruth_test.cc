// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/icl_groundtruth.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"
#include "support/made_room.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// The pixel of a point in a camera whose y axis points up (fy < 0). Pose and point are those of its
// left-handed world.
Eigen::Vector2d PixelWithYUp(const PinholeCamera& camera, const Rigid3& world_from_cam,
                             const Eigen::Vector3d& point) {
  const Eigen::Vector3d seen = Inverse(world_from_cam) * point;
  return {camera.cx + camera.fx * seen.x() / seen.z(), camera.cy - camera.fy * seen.y() / seen.z()};
}

TEST(MirrorY, TheMirroredCameraSeesThePixelsInTheMirroredWorld) {
  const PinholeCamera camera = MadeRoom().camera();
  const Rigid3 pose(ExpSo3({0.3, -0.5, 0.2}), {0.4, -1.2, 2.0});
  for (const Eigen::Vector3d& seen :
       {Eigen::Vector3d(0.5, 0.3, 2.0), Eigen::Vector3d(-1.0, -0.7, 3.0)}) {
    const Eigen::Vector3d point = pose * seen;
    const Eigen::Vector3d mirrored(point.x(), -point.y(), point.z());
    const Eigen::Vector2d pixel = camera.Project(Inverse(MirrorY(pose)) * mirrored);
    EXPECT_LT((pixel - PixelWithYUp(camera, pose, point)).norm(), 1e-9);
  }
}

TEST(MirrorY, IsItsOwnInverseAndKeepsProducts) {
  const Rigid3 a(ExpSo3({0.3, -0.5, 0.2}), {0.4, -1.2, 2.0});
  const Rigid3 b(ExpSo3({-0.1, 0.4, 1.1}), {-2.0, 0.3, 0.1});
  EXPECT_TRUE(MirrorY(MirrorY(a)).ToMatrix().isApprox(a.ToMatrix(), 1e-12));
  EXPECT_TRUE(MirrorY(a * b).ToMatrix().isApprox((MirrorY(a) * MirrorY(b)).ToMatrix(), 1e-12));
}

TEST(ReadIndexedTrajectory, StampsBecomeSeconds) {
  const TemporaryFolder folder;
  const Trajectory read =
      ReadIndexedTrajectory(folder.Write("a.txt", "1 0 0 -2.25 0 0 0 1\n30 0 0 1 0 0 0 1\n"));
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].timestamp, 1.0 / 30.0);
  EXPECT_EQ(read[1].timestamp, 1.0);
  EXPECT_EQ(read[0].world_from_cam.translation.z(), -2.25);
  for (const char* const stamp : {"0.5", "-1"}) {
    const auto path = folder.Write("b.txt", std::string(stamp) + " 0 0 0 0 0 0 1\n");
    ExpectInputError([&] { ReadIndexedTrajectory(path); }, {"b.txt", stamp, "index of a frame"});
  }
}

class MeasureYAxisTest : public ::testing::Test {
 protected:
  MeasureYAxisTest() {
    room_.WriteIclTum(folder_.path(), 16, true);
    for (int i = 0; i < 16; ++i) {
      const std::string name = std::to_string(i) + ".png";
      sequence_.frames.push_back(
          {i / 30.0, folder_.path() / "rgb" / name, folder_.path() / "depth" / name});
      up_.push_back({i / 30.0, MadeRoom::PoseWithYUp(i)});
    }
  }

  YAxisVotes Measure(const Trajectory& poses) {
    return MeasureYAxis(sequence_, poses, room_.camera(), DepthOptions());
  }

  TemporaryFolder folder_;
  MadeRoom room_{4};
  ImageSequence sequence_;
  Trajectory up_;
};

TEST_F(MeasureYAxisTest, DepthTellsTheAxis) {
  const YAxisVotes up = Measure(up_);
  EXPECT_GT(up.both + up.only_up, up.pixels * 9 / 10);
  EXPECT_GT(up.only_up, up.pixels / 10);
  EXPECT_LT(up.only_down, up.pixels / 100);
  const YAxisVotes down = Measure(MirrorY(up_));
  EXPECT_EQ(down.pixels, up.pixels);
  EXPECT_EQ(down.only_down, up.only_up);
  EXPECT_EQ(down.only_up, up.only_down);
}

TEST_F(MeasureYAxisTest, FramesWithoutPoseOrReadableDepthAreSkipped) {
  EXPECT_EQ(Measure({up_.begin(), up_.begin() + 1}).pixels, 0U);
  for (int i = 1; i < 15; ++i) {
    folder_.Write("depth/" + std::to_string(i) + ".png", "broken");
  }
  const YAxisVotes votes = Measure(up_);  // frames 0 and 15 are left
  EXPECT_GT(votes.pixels, 100U);
  EXPECT_GT(votes.only_up, votes.only_down);
  for (FramePaths& frame : sequence_.frames) {
    frame.depth.clear();
  }
  EXPECT_EQ(Measure(up_).pixels, 0U);
}

}  // namespace

}  // namespace hullslam

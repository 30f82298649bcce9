// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/icl_povray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "files/read_file.h"
#include "support/expect_error.h"
#include "support/made_room.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

constexpr double kUnits = 100.0;  // units of length of the files per metre

class IclPovrayTest : public ::testing::Test {
 protected:
  IclPovrayTest() { room_.WriteIclPovray(folder_.path(), 2); }

  std::string Path(const std::string& name) const { return folder_.path() / name; }

  TemporaryFolder folder_;
  MadeRoom room_{8};
};

TEST_F(IclPovrayTest, ListsFramesByIndex) {
  EXPECT_TRUE(HasPovrayFrames(folder_.path()));
  folder_.Write("scene_00_0010.png", "");
  folder_.Write("scene_00_0009.png", "");
  folder_.Write("scene_00_x.png", "");
  folder_.Write("other.png", "");
  const std::vector<FramePaths> frames = ListPovrayFrames(folder_.path());
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[1].timestamp, 1.0 / 30.0);
  EXPECT_EQ(frames[3].timestamp, 10.0 / 30.0);
  EXPECT_EQ(frames[3].image, Path("scene_00_0010.png"));
  EXPECT_EQ(frames[3].depth, Path("scene_00_0010.depth"));
  EXPECT_EQ(frames[3].number, 3U);
}

TEST_F(IclPovrayTest, FoldersWithNoneOrTwoScenesAreRefused) {
  folder_.Write("scene_01_0001.png", "");
  ExpectInputError([&] { ListPovrayFrames(folder_.path()); }, {"two scenes", "scene_01_0001.png"});
  const TemporaryFolder empty;
  EXPECT_FALSE(HasPovrayFrames(empty.path()));
  ExpectInputError([] { HasPovrayFrames("/no/such"); }, {"/no/such: No such file"});
  ExpectInputError([&] { ListPovrayFrames(empty.path()); }, {"has no images scene_NN_NNNN.png"});
}

// The tolerance is that of the files, which have 8 decimals.
TEST_F(IclPovrayTest, CamerasAreThoseOfTheRightHandedRoom) {
  const auto read = ReadPovrayTrajectory(ListPovrayFrames(folder_.path()), kUnits);
  ASSERT_TRUE(read && read->size() == 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE((*read)[i].world_from_cam.ToMatrix().isApprox(MadeRoom::Pose(i).ToMatrix(), 1e-6));
  }
}

TEST_F(IclPovrayTest, ACameraWithoutItsFileIsReported) {
  std::filesystem::remove(Path("scene_00_0001.txt"));
  ExpectInputError([&] { ReadPovrayTrajectory(ListPovrayFrames(folder_.path()), kUnits); },
                   {"scene_00_0001.txt", "No such file"});
  std::filesystem::remove(Path("scene_00_0000.txt"));
  EXPECT_FALSE(ReadPovrayTrajectory(ListPovrayFrames(folder_.path()), kUnits).has_value());
}

TEST_F(IclPovrayTest, BrokenCamerasAreReported) {
  const std::string good = "cam_dir = [0, 0, 1]';\ncam_up = [0, 1, 0]';\n";
  const auto expect = [&](const std::string& text, const std::vector<std::string>& parts) {
    const auto path = folder_.Write("camera.txt", text);
    ExpectInputError([&] { ReadPovrayCamera(path, 1.0); }, parts);
  };
  expect(good, {"camera.txt: cam_pos is not given"});
  for (const char* const value : {"[1, 2]';", "[1, 2, x]';", "[1, 2, 3, 4]", "1, 2, 3",
                                  "[1, 2, nan]", "[1, 2, 1e300]", "", "]1, 2, 3["}) {
    expect(good + "cam_pos = " + value + '\n', {"camera.txt:3: cam_pos is '", "[x, y, z]"});
  }
  expect("cam_pos = [0, 0, 0]\ncam_dir = [0, 2, 0]\ncam_up = [0, 1, 0]\n", {"are parallel"});
  const auto path = folder_.Write("camera.txt", "\ncam_pos=[4,2,3]\n" + good);
  EXPECT_TRUE(ReadPovrayCamera(path, 2.0).translation.isApprox(Eigen::Vector3d(2.0, -1.0, 1.5)));
}

TEST_F(IclPovrayTest, DistancesAlongRaysBecomeDepth) {
  const FramePaths frame = ListPovrayFrames(folder_.path())[1];
  const ImageInput input = LoadPovrayFrame(frame, room_.camera(), kUnits);
  const MadeRoom::Images made = room_.Render(1);
  EXPECT_EQ(input.timestamp, frame.timestamp);
  EXPECT_EQ(cv::norm(input.grey, made.grey, cv::NORM_INF), 0.0);
  ASSERT_EQ(input.depth.type(), CV_32FC1);
  cv::Mat expected;
  made.depth.convertTo(expected, CV_32F, 1.0 / 5000.0);
  EXPECT_LT(cv::norm(input.depth, expected, cv::NORM_INF), 2e-4);
  EXPECT_TRUE(LoadPovrayFrame({0.0, frame.image}, room_.camera(), kUnits).depth.empty());
}

TEST_F(IclPovrayTest, BrokenDepthIsReported) {
  const PinholeCamera camera{.fx = 4.0, .fy = 4.0, .cx = 0.0, .cy = 0.0, .width = 2, .height = 2};
  const auto expect = [&](const std::string& text, const std::vector<std::string>& parts) {
    const auto path = folder_.Write("a.depth", text);
    ExpectInputError([&] { ReadRayDepth(path, camera, 1.0); }, parts);
  };
  expect("", {"a.depth: has 0 numbers", "2x2"});
  expect("1 2 3", {"has 3 numbers"});
  expect("1 2 3 4 5", {"has 5 numbers"});
  expect("1 2 -3 4", {"a.depth: number 3 is '-3'", "expected a distance"});
  expect("1 2 3 nan", {"number 4 is 'nan'"});
  const cv::Mat depth = ReadRayDepth(folder_.Write("a.depth", "1 2\n3\t4\n"), camera, 1.0);
  EXPECT_EQ(depth.at<float>(0, 0), 1.0F);
  EXPECT_NEAR(depth.at<float>(1, 0), 3.0 / std::hypot(1.0, 0.25), 1e-6);
}

}  // namespace
}  // namespace hullslam

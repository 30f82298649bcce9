// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/run_pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "support/made_view.h"
#include "support/synthetic_world.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// Two images of 64x48 px: a red one at 100.5 s and a blue one at 101 s, and one that is missing.
class RunPicturesTest : public ::testing::Test {
 protected:
  RunPicturesTest() {
    Add(100.5, cv::Scalar(0, 0, 255));
    Add(101.0, cv::Scalar(255, 0, 0));
    sequence_.frames.push_back({.timestamp = 102.0, .image = folder_.path() / "missing.png"});
  }
  void Add(double timestamp, const cv::Scalar& colour) {
    const std::string file = folder_.path() / (std::to_string(timestamp) + ".png");
    cv::imwrite(file, cv::Mat(48, 64, CV_8UC3, colour));
    sequence_.frames.push_back({.timestamp = timestamp, .image = file});
  }
  LeftOutTasks Run(std::vector<ImageTask> tasks) const {
    return RunImageTasks(sequence_, MadeCamera(), std::move(tasks));
  }

  TemporaryFolder folder_;
  ImageSequence sequence_;
};

TEST_F(RunPicturesTest, EachTaskGetsTheImageOfItsMoment) {
  std::vector<cv::Vec3b> seen;
  const auto note = [&](const cv::Mat& image) { seen.push_back(image.at<cv::Vec3b>(0, 0)); };
  const LeftOutTasks left_out =
      Run({{101.0, note}, {100.5, note}, {100.7, note}, {102.0, note}, {9.0, note}});
  EXPECT_EQ(left_out.absent, 2u);  // at 100.7 and at 9 s
  EXPECT_EQ(left_out.unreadable, 1u);
  EXPECT_EQ(seen, (std::vector<cv::Vec3b>{{0, 0, 255}, {255, 0, 0}}));
}

TEST_F(RunPicturesTest, AnImageOfAnotherSizeIsNotUsed) {
  PinholeCamera camera = MadeCamera();
  camera.width = 32;
  EXPECT_EQ(RunImageTasks(sequence_, camera, {{100.5, [](const cv::Mat&) { FAIL(); }}}).unreadable,
            1u);
}

TEST_F(RunPicturesTest, LandmarksGetTheMeanColourOfTheImages) {
  const SyntheticWorld world;
  const Map map = MakeSyntheticMap(world, {0, 10}).map;
  std::vector<LandmarkId> ids;
  map.landmarks().ForEach([&](LandmarkId id, const Landmark&) { ids.push_back(id); });
  PointColours colours(map, ids);
  const PinholeCamera camera = world.sensor().camera;
  std::vector<ImageTask> tasks = ColourTasks(map, camera, colours);
  ASSERT_EQ(tasks.size(), 2u);
  const cv::Size size(camera.width, camera.height);
  tasks[0].use(cv::Mat(size, CV_8UC3, cv::Scalar(10, 20, 30)));
  tasks[1].use(cv::Mat(size, CV_8UC3, cv::Scalar(20, 40, 60)));
  const std::vector<Colour> list = colours.Colours();
  EXPECT_EQ(std::count(list.begin(), list.end(), Colour{45, 30, 15}),
            static_cast<ptrdiff_t>(list.size()));
  EXPECT_EQ(tasks[1].timestamp, map.keyframes().At(KeyframeId(1)).frame->timestamp);
}

TEST_F(RunPicturesTest, PicturesHaveOutlinesAndCutoutsShowTheObject) {
  ViewModel model = MadeView(0);
  model.pictures.clear();
  model.keyframes.poses = {{100.5, Rigid3()}, {101.0, Rigid3()}};
  EXPECT_EQ(Run(PictureTasks(10, model)).unreadable, 0u);
  ASSERT_EQ(model.pictures.size(), 2u);
  const ViewPicture& picture = model.pictures[0];
  EXPECT_EQ(picture.width, 64);
  ASSERT_EQ(picture.outlines.size(), 1u);
  EXPECT_EQ(picture.outlines[0].object, ObjectId(7));
  EXPECT_EQ(picture.outlines[0].points[0], Eigen::Vector2d(22.0, 14.0));
  ASSERT_EQ(picture.ellipses.size(), 1u);
  // The sphere is seen as a circle of 100 * 0.2 / sqrt(2^2 - 0.2^2) = 10.05 px around the middle.
  for (const Eigen::Vector2d& point : picture.ellipses[0].points) {
    EXPECT_NEAR((point - Eigen::Vector2d(32.0, 24.0)).norm(), 10.05, 0.05);
  }
  EXPECT_TRUE(model.pictures[1].outlines.empty());

  ASSERT_EQ(model.objects[0].cutouts.size(), 1u);
  const ViewPicture& cutout = model.objects[0].cutouts[0];
  const std::vector<char> bytes(cutout.jpeg.begin(), cutout.jpeg.end());
  const cv::Mat image = cv::imdecode(bytes, cv::IMREAD_COLOR);
  EXPECT_EQ(image.cols, cutout.width);
  EXPECT_GT(image.at<cv::Vec3b>(5, 5)[2], 200);  // red
  for (const Eigen::Vector2d& point : cutout.outlines[0].points) {
    EXPECT_GT(point.minCoeff(), 1.0);  // the whole object with a margin
    EXPECT_LT(point.x(), cutout.width - 1.0);
    EXPECT_LT(point.y(), cutout.height - 1.0);
  }
}

TEST_F(RunPicturesTest, BestViewsAreLargeAndFromDifferentSides) {
  ViewModel model = MadeView(0);
  ObjectResult& object = model.objects[0].object;
  const ObservationResult first = object.observations[0];
  object.observations.push_back(first);
  object.observations[1].score = 0.9;  // the same side as the first view, but worse
  object.observations.push_back(first);
  object.observations[2].score = 0.5;
  object.observations[2].timestamp = 101.0;
  // From the side: the camera is at (2, 0, 2) and looks along -x.
  const Eigen::Quaterniond turn = ExpSo3({0.0, std::numbers::pi / 2.0, 0.0});
  object.observations[2].cam_from_world = Rigid3(turn, turn * Eigen::Vector3d(-2.0, 0.0, -2.0));
  Run(PictureTasks(0, model));
  ASSERT_EQ(model.objects[0].cutouts.size(), 3u);
  EXPECT_EQ(model.objects[0].cutouts[0].timestamp, 100.5);
  EXPECT_EQ(model.objects[0].cutouts[1].timestamp, 101.0);
}

}  // namespace
}  // namespace hullslam

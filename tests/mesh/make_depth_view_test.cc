// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/make_depth_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "support/drawn_depth.h"
#include "support/fisheye_camera.h"

namespace hullslam {
namespace {

TEST(MakeDepthView, RaysShowTheirPixels) {
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

TEST(MakeDepthView, RowsHavePosesOnlyWithARollingShutter) {
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

TEST(MakeDepthView, WeightsAreThoseOfTheDepthError) {
  const DepthView near = ViewOf(Wall(1.0));
  const DepthView far = ViewOf(Wall(2.0));
  const double sigma = SystemOptions().depth.error.disparity_sigma / 12.0;  // m at 1 m
  EXPECT_NEAR(near.weight.at<float>(60, 80), 1.0 / (sigma * sigma), 0.01);
  EXPECT_NEAR(near.weight.at<float>(60, 80) / far.weight.at<float>(60, 80), 16.0, 0.01);
  EXPECT_NEAR(near.cosine.at<float>(60, 80), 1.0, 1e-3);
  // 45 degrees at the border of the image would be 80 px from the centre.
  EXPECT_NEAR(near.cosine.at<float>(60, 140), std::cos(std::atan(60.5 / 160.0)), 1e-3);
}

TEST(MakeDepthView, BordersGrazingAnglesAndFarDepthsAreNotUsed) {
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

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/stereo_rectifier.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "support/expect_error.h"

namespace hullslam {
namespace {

// Two cameras with lenses of their own, 0.12 m apart, that look in slightly different directions.
StereoCalibration MadePair() {
  StereoCalibration pair;
  pair.left = {.fx = 460.0,
               .fy = 458.0,
               .cx = 318.0,
               .cy = 243.0,
               .k1 = -0.28,
               .k2 = 0.07,
               .p1 = 1e-4,
               .p2 = -2e-4};
  pair.right = {.fx = 455.0, .fy = 456.0, .cx = 325.0, .cy = 238.0, .k1 = -0.27, .k2 = 0.06};
  pair.right_from_left = {
      Eigen::Quaterniond(Eigen::AngleAxisd(0.02, Eigen::Vector3d(0.3, 0.8, 0.5).normalized())),
      {-0.12, 0.002, 0.003}};
  return pair;
}

TEST(StereoRectifier, APointLiesInOneRowAndItsDisparityTellsItsDepth) {
  const StereoCalibration pair = MadePair();
  const StereoRectifier rectifier(pair, "test");
  const PinholeCamera& camera = rectifier.camera();
  EXPECT_FALSE(camera.IsDistorted());
  EXPECT_FALSE(rectifier.IsIdentity());
  const Rigid3 right_from_left =
      Inverse(rectifier.rectified_from_right()) * rectifier.rectified_from_left();
  EXPECT_LT(AngularDistance(right_from_left.rotation, pair.right_from_left.rotation), 1e-9);
  EXPECT_NEAR(camera.bf / camera.fx, Inverse(pair.right_from_left).translation.norm(), 1e-9);
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0.1, -0.2, 1.5), Eigen::Vector3d(-0.4, 0.3, 2.0)}) {
    // A dot at the pixel where each camera sees the point.
    const auto draw = [&](const PinholeCamera& of, const Eigen::Vector3d& in_camera) {
      cv::Mat image(of.height, of.width, CV_8UC1, cv::Scalar(0));
      const Eigen::Vector2d pixel = of.Distort(of.Project(in_camera));
      for (int y = 0; y < image.rows; ++y) {
        for (int x = 0; x < image.cols; ++x) {
          const double r2 = (Eigen::Vector2d(x, y) - pixel).squaredNorm();
          image.at<uint8_t>(y, x) = static_cast<uint8_t>(250.0 * std::exp(-r2 / 18.0));
        }
      }
      return image;
    };
    const auto find = [](const cv::Mat& image) {
      const cv::Moments moments = cv::moments(image);
      return Eigen::Vector2d(moments.m10 / moments.m00, moments.m01 / moments.m00);
    };
    const Eigen::Vector2d left = find(rectifier.Rectify(draw(pair.left, point), ImageSide::kLeft));
    const Eigen::Vector2d right =
        find(rectifier.Rectify(draw(pair.right, pair.right_from_left * point), ImageSide::kRight));
    EXPECT_NEAR(left.y(), right.y(), 0.1);
    const Eigen::Vector3d rectified = rectifier.rectified_from_left() * point;
    EXPECT_LT((left - camera.Project(rectified)).norm(), 0.15);
    EXPECT_NEAR(camera.bf / (left.x() - right.x()), rectified.z(), 0.02 * rectified.z());
  }
}

TEST(StereoRectifier, PixelsFollowTheLeftImage) {
  const StereoCalibration pair = MadePair();
  const StereoRectifier rectifier(pair, "test");
  const Eigen::Vector3d point(0.2, 0.1, 1.0);
  const Eigen::Vector2d pixel =
      rectifier.Rectify(pair.left.Distort(pair.left.Project(point)), ImageSide::kLeft);
  const Eigen::Vector2d expected =
      rectifier.camera().Project(rectifier.rectified_from_left() * point);
  EXPECT_LT((pixel - expected).norm(), 1e-4);
}

TEST(StereoRectifier, ARectifiedPairStaysAsItIs) {
  StereoCalibration pair;
  pair.left = {.fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0};
  pair.right = pair.left;
  pair.right_from_left.translation = {-0.1, 0.0, 0.0};
  const StereoRectifier rectifier(pair, "test");
  EXPECT_DOUBLE_EQ(rectifier.camera().bf, 50.0);
  EXPECT_TRUE(rectifier.IsIdentity());
  const cv::Mat image(480, 640, CV_8UC1, cv::Scalar(7));
  EXPECT_EQ(rectifier.Rectify(image, ImageSide::kLeft).data, image.data);
  EXPECT_EQ(rectifier.Rectify(image, ImageSide::kRight).data, image.data);
}

TEST(StereoRectifier, PairsThatCannotBeRectifiedAreRefused) {
  const auto expect = [](const StereoCalibration& pair, const std::vector<std::string>& parts) {
    ExpectInputError([&] { StereoRectifier(pair, "c.yaml"); }, parts);
  };
  StereoCalibration pair = MadePair();
  pair.right.width = 320;
  expect(pair, {"c.yaml: ", "640x480", "320x480", "equal sizes"});
  pair = MadePair();
  pair.right_from_left.translation.setZero();
  expect(pair, {"the baseline is 0 m"});
  pair = MadePair();
  pair.right_from_left = Inverse(pair.right_from_left);
  expect(pair, {"0.120 m to the left", "swapped"});
  pair.right_from_left = {Eigen::Quaterniond::Identity(), {0.0, -0.12, 0.0}};
  expect(pair, {"along x"});
}

}  // namespace
}  // namespace hullslam

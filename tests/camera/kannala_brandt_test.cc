// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/kannala_brandt.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "support/fisheye_camera.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Undistorted pixels up to this angle from the axis, in all directions.
std::vector<Eigen::Vector2d> PixelsUpTo(const PinholeCamera& camera, double most_angle) {
  std::vector<Eigen::Vector2d> pixels;
  for (double angle = 0.5 * kDegree; angle < most_angle; angle += 4.0 * kDegree) {
    for (double turn = 0.1; turn < 6.28; turn += 0.7) {
      pixels.push_back(camera.Project(
          {std::tan(angle) * std::cos(turn), std::tan(angle) * std::sin(turn), 1.0}));
    }
  }
  return pixels;
}

TEST(KannalaBrandt, AgreesWithOpenCv) {
  const PinholeCamera camera = FisheyeCamera();
  for (const Eigen::Vector2d& pixel : PixelsUpTo(camera, 79.0 * kDegree)) {
    const Eigen::Vector3d ray = camera.Unproject(pixel, 1.0);
    const std::vector<cv::Point2d> points = {{ray.x(), ray.y()}};
    std::vector<cv::Point2d> distorted;
    cv::fisheye::distortPoints(
        points, distorted,
        cv::Matx33d(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0),
        cv::Vec4d(camera.k1, camera.k2, camera.k3, camera.k4));
    const Eigen::Vector2d expected(distorted[0].x, distorted[0].y);
    EXPECT_LT((camera.Distort(pixel) - expected).norm(), 1e-9) << pixel.transpose();
  }
}

TEST(KannalaBrandt, UndistortInvertsDistort) {
  const PinholeCamera camera = FisheyeCamera();
  for (const Eigen::Vector2d& pixel : PixelsUpTo(camera, 79.5 * kDegree)) {
    const Eigen::Vector2d raw = camera.Distort(pixel);
    EXPECT_LT((camera.Undistort(raw) - pixel).norm(), 1e-8 * pixel.norm()) << pixel.transpose();
    EXPECT_LT((camera.Distort(camera.Undistort(raw)) - raw).norm(), 1e-9);
  }
  EXPECT_EQ(camera.Undistort({camera.cx, camera.cy}), Eigen::Vector2d(camera.cx, camera.cy));
}

TEST(KannalaBrandt, JacobianIsTrue) {
  const PinholeCamera camera = FisheyeCamera();
  for (const Eigen::Vector2d& pixel : PixelsUpTo(camera, 79.0 * kDegree)) {
    const Eigen::Matrix2d jacobian = camera.DistortionJacobian(pixel);
    constexpr double kStep = 1e-3;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
      const Eigen::Vector2d slope =
          (camera.Distort(pixel + step) - camera.Distort(pixel - step)) / (2.0 * kStep);
      EXPECT_LT((slope - jacobian.col(axis)).norm(), 1e-7) << pixel.transpose();
    }
  }
}

TEST(KannalaBrandt, RawPixelsBeyondTheLargestAngleGiveThePixelThere) {
  const PinholeCamera camera = FisheyeCamera();
  const Eigen::Vector2d beyond = camera.Undistort({camera.cx + 500.0, camera.cy});
  EXPECT_NEAR(beyond.x(), camera.cx + camera.fx * std::tan(PinholeCamera::kMostAngle), 1e-6);
  const double limit = camera.fx * RadiusOfAngle(camera, PinholeCamera::kMostAngle);
  EXPECT_TRUE(camera.SeesRaw({camera.cx - 0.5 * limit, camera.cy}));
  PinholeCamera large = camera;
  large.width = 1000;
  large.cx = 500.0;
  EXPECT_TRUE(large.SeesRaw({large.cx + limit - 0.1, large.cy}));
  EXPECT_FALSE(large.SeesRaw({large.cx + limit + 0.1, large.cy}));
  EXPECT_FALSE(camera.SeesRaw({-0.1, camera.cy}));
}

TEST(KannalaBrandt, RaysHaveTheirPixelsInAllDirections) {
  const PinholeCamera camera = FisheyeCamera();
  RandomGeometry random(3);
  const double largest = LargestAngle(camera, std::numbers::pi);
  EXPECT_EQ(largest, std::numbers::pi);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d ray = random.Vector(1.0).normalized();
    const Eigen::Vector2d raw = RawPixelOfRay(camera, 3.0 * ray);
    EXPECT_LT((RayOfRawPixel(camera, raw, largest) - ray).norm(), 1e-7) << ray.transpose();
    if (ray.z() > 0.2) {
      EXPECT_LT((camera.Distort(camera.Project(ray)) - raw).norm(), 1e-8);
    }
  }
  EXPECT_EQ(RayOfRawPixel(camera, {camera.cx, camera.cy}, largest), Eigen::Vector3d::UnitZ());
}

// t (1 - t^2 / 3) has its maximum 2/3 at t = 1.
TEST(KannalaBrandt, TheFoldIsFound) {
  PinholeCamera camera = FisheyeCamera();
  camera.k1 = -1.0 / 3.0;
  camera.k2 = camera.k3 = camera.k4 = 0.0;
  EXPECT_NEAR(LargestAngle(camera, 1.4), 1.0, 0.004);
  EXPECT_NEAR(camera.FoldRadius(), camera.fx * 2.0 / 3.0, 0.01);
  EXPECT_EQ(FisheyeCamera().FoldRadius(), std::numeric_limits<double>::infinity());
  const Eigen::Vector2d beyond = camera.Undistort({camera.cx + 5.0 * camera.fx, camera.cy});
  EXPECT_NEAR(beyond.x(), camera.cx + camera.fx * std::tan(1.0), 5.0);
}

TEST(KannalaBrandt, APinholeAsFisheyeIsThePinhole) {
  const PinholeCamera camera = PinholeAsFisheye();
  for (int y = 0; y <= camera.height; y += 40) {
    for (int x = 0; x <= camera.width; x += 40) {
      EXPECT_LT((camera.Undistort({x, y}) - Eigen::Vector2d(x, y)).norm(), 0.05);
    }
  }
  EXPECT_EQ(camera.FindFault(), "");
}

}  // namespace
}  // namespace hullslam

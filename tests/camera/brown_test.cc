// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/brown.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <vector>

namespace hullslam {
namespace {

// The colour camera of an Azure Kinect, which has a rational lens.
PinholeCamera Rational() {
  return {.fx = 607.0,
          .fy = 607.1,
          .cx = 640.2,
          .cy = 366.9,
          .k1 = 0.5265,
          .k2 = -2.6931,
          .p1 = 0.00056,
          .p2 = -0.00017,
          .k3 = 1.5452,
          .width = 1280,
          .height = 720,
          .k4 = 0.4068,
          .k5 = -2.5134,
          .k6 = 1.4728};
}

std::vector<Eigen::Vector2d> RawGridOf(const PinholeCamera& camera) {
  std::vector<Eigen::Vector2d> pixels;
  for (int y = 0; y <= camera.height; y += 40) {
    for (int x = 0; x <= camera.width; x += 40) {
      pixels.emplace_back(x, y);
    }
  }
  return pixels;
}

TEST(BrownRational, AgreesWithOpenCv) {
  const PinholeCamera camera = Rational();
  const cv::Vec<double, 8> coefficients(camera.k1, camera.k2, camera.p1, camera.p2, camera.k3,
                                        camera.k4, camera.k5, camera.k6);
  for (const Eigen::Vector2d& pixel : RawGridOf(camera)) {
    const Eigen::Vector3d ray = camera.Unproject(pixel, 1.0);
    std::vector<cv::Point2d> projected;
    cv::projectPoints(
        std::vector<cv::Point3d>{{ray.x(), ray.y(), ray.z()}}, cv::Vec3d(), cv::Vec3d(),
        cv::Matx33d(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0),
        coefficients, projected);
    const Eigen::Vector2d expected(projected[0].x, projected[0].y);
    EXPECT_LT((camera.Distort(pixel) - expected).norm(), 1e-9) << pixel.transpose();
  }
}

TEST(BrownRational, UndistortInvertsDistort) {
  const PinholeCamera camera = Rational();
  EXPECT_EQ(camera.FindFault(), "");
  for (const Eigen::Vector2d& raw : RawGridOf(camera)) {
    EXPECT_LT((camera.Distort(camera.Undistort(raw)) - raw).norm(), 1e-6) << raw.transpose();
  }
}

TEST(BrownRational, JacobianIsTrue) {
  const PinholeCamera camera = Rational();
  for (const Eigen::Vector2d& pixel : RawGridOf(camera)) {
    const Eigen::Matrix2d jacobian = camera.DistortionJacobian(pixel);
    constexpr double kStep = 1e-4;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
      const Eigen::Vector2d slope =
          (camera.Distort(pixel + step) - camera.Distort(pixel - step)) / (2.0 * kStep);
      EXPECT_LT((slope - jacobian.col(axis)).norm(), 1e-6) << pixel.transpose();
    }
  }
}

// Equal polynomials above and below cancel, so that no pixel moves.
TEST(BrownRational, EqualPolynomialsCancel) {
  const PinholeCamera camera{
      .fx = 500, .fy = 500, .cx = 320, .cy = 240, .k1 = 0.3, .k2 = -0.1, .k4 = 0.3, .k5 = -0.1};
  EXPECT_TRUE(camera.IsDistorted());
  EXPECT_LT((camera.Undistort({13.0, 470.0}) - Eigen::Vector2d(13.0, 470.0)).norm(), 1e-9);
}

// r (1 - r^2) has its maximum 0.385 at r = 0.577.
TEST(BrownFold, IsTheRadiusWhereTheImageFolds) {
  PinholeCamera camera{.fx = 500, .fy = 520, .cx = 320, .cy = 240, .k1 = -1.0};
  EXPECT_NEAR(camera.FoldRadius(), 500 * 0.3849, 0.05);
  camera.k1 = 0.2;
  EXPECT_EQ(camera.FoldRadius(), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace hullslam

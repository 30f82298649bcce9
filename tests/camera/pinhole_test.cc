// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/camera/pinhole.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "hullslam/util/error.h"
#include "support/test_cameras.h"

namespace hullslam {
namespace {

// The camera of TUM freiburg1, which has the strongest distortion of the cameras that ORB-SLAM2
// ships settings for.
PinholeCamera Tum1() {
  return {.fx = 517.306408,
          .fy = 516.469215,
          .cx = 318.643040,
          .cy = 255.313989,
          .k1 = 0.262383,
          .k2 = -0.953104,
          .p1 = -0.005358,
          .p2 = 0.002628,
          .k3 = 1.163314};
}

cv::Matx33d Intrinsics(const PinholeCamera& camera) {
  return {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
}

cv::Vec<double, 5> Coefficients(const PinholeCamera& camera) {
  return {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3};
}

std::vector<Eigen::Vector2d> PixelsOf(const PinholeCamera& camera) {
  std::vector<Eigen::Vector2d> pixels;
  for (int y = 0; y <= camera.height; y += 16) {
    for (int x = 0; x <= camera.width; x += 16) {
      pixels.emplace_back(x, y);
    }
  }
  return pixels;
}

TEST(PinholeCamera, ProjectsAsComputedByHand) {
  const PinholeCamera camera{.fx = 500.0, .fy = 400.0, .cx = 320.0, .cy = 240.0};
  EXPECT_EQ(camera.Project({1.0, -0.5, 2.0}), Eigen::Vector2d(570.0, 140.0));
  EXPECT_EQ(camera.Project({0.0, 0.0, 7.0}), Eigen::Vector2d(320.0, 240.0));
  EXPECT_EQ(camera.Unproject({570.0, 140.0}, 2.0), Eigen::Vector3d(1.0, -0.5, 2.0));
}

TEST(PinholeCamera, UnprojectInvertsProject) {
  const PinholeCamera camera = Tum1();
  for (const Eigen::Vector2d& pixel : PixelsOf(camera)) {
    const Eigen::Vector3d point = camera.Unproject(pixel, 1.7);
    EXPECT_DOUBLE_EQ(point.z(), 1.7);
    EXPECT_LT((camera.Project(point) - pixel).norm(), 1e-10);
  }
}

TEST(PinholeCamera, UndistortInvertsDistort) {
  const PinholeCamera camera = Tum1();
  for (const Eigen::Vector2d& raw : PixelsOf(camera)) {
    EXPECT_LT((camera.Distort(camera.Undistort(raw)) - raw).norm(), 1e-6) << raw.transpose();
  }
}

TEST(PinholeCamera, DistortAgreesWithOpenCv) {
  const PinholeCamera camera = Tum1();
  for (const Eigen::Vector2d& pixel : PixelsOf(camera)) {
    const Eigen::Vector3d point = camera.Unproject(pixel, 1.0);
    const std::vector<cv::Point3d> points = {{point.x(), point.y(), point.z()}};
    std::vector<cv::Point2d> projected;
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), Intrinsics(camera), Coefficients(camera),
                      projected);
    const Eigen::Vector2d expected(projected[0].x, projected[0].y);
    EXPECT_LT((camera.Distort(pixel) - expected).norm(), 1e-9);
  }
}

TEST(PinholeCamera, UndistortAgreesWithOpenCv) {
  const PinholeCamera camera = Tum1();
  for (const Eigen::Vector2d& raw : PixelsOf(camera)) {
    const std::vector<cv::Point2d> points = {{raw.x(), raw.y()}};
    std::vector<cv::Point2d> undistorted;
    cv::undistortPoints(
        points, undistorted, Intrinsics(camera), Coefficients(camera), cv::noArray(),
        Intrinsics(camera),
        cv::TermCriteria(cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, 200, 1e-10));
    const Eigen::Vector2d expected(undistorted[0].x, undistorted[0].y);
    EXPECT_LT((camera.Undistort(raw) - expected).norm(), 1e-6) << raw.transpose();
  }
}

TEST(PinholeCamera, PrincipalPointIsNotMoved) {
  const PinholeCamera camera = Tum1();
  const Eigen::Vector2d center(camera.cx, camera.cy);
  EXPECT_LT((camera.Distort(center) - center).norm(), 1e-12);
  EXPECT_LT((camera.Undistort(center) - center).norm(), 1e-12);
}

TEST(PinholeCamera, WithoutDistortionNoPixelMoves) {
  PinholeCamera camera = Tum1();
  camera.k1 = camera.k2 = camera.p1 = camera.p2 = camera.k3 = 0.0;
  EXPECT_FALSE(camera.IsDistorted());
  EXPECT_EQ(camera.Undistort({17.25, 400.5}), Eigen::Vector2d(17.25, 400.5));
  const PinholeCamera::Bounds bounds = camera.UndistortedBounds();
  EXPECT_EQ(bounds.min_x, 0.0);
  EXPECT_EQ(bounds.min_y, 0.0);
  EXPECT_EQ(bounds.max_x, 640.0);
  EXPECT_EQ(bounds.max_y, 480.0);
}

// r (1 - r^2) has its maximum 0.385 at r = 0.577, so no undistorted point lies beyond.
TEST(PinholeCamera, UndistortStopsAtAFold) {
  const PinholeCamera camera{.fx = 100.0, .fy = 100.0, .cx = 0.0, .cy = 0.0, .k1 = -1.0};
  const Eigen::Vector2d inside = camera.Undistort({38.0, 0.0});
  EXPECT_LT((camera.Distort(inside) - Eigen::Vector2d(38.0, 0.0)).norm(), 1e-6);
  EXPECT_LT(inside.x(), 57.8);
  for (const double x : {38.6, 60.0, 300.0, 1e6}) {
    const Eigen::Vector2d beyond = camera.Undistort({x, 0.5 * x});
    EXPECT_TRUE(beyond.allFinite()) << x;
  }
}

TEST(PinholeCamera, BoundsContainTheImage) {
  const PinholeCamera camera = Tum1();
  const PinholeCamera::Bounds bounds = camera.UndistortedBounds();
  for (const Eigen::Vector2d& raw : PixelsOf(camera)) {
    const Eigen::Vector2d pixel = camera.Undistort(raw);
    EXPECT_GE(pixel.x(), bounds.min_x - 0.5) << raw.transpose();
    EXPECT_LE(pixel.x(), bounds.max_x + 0.5) << raw.transpose();
    EXPECT_GE(pixel.y(), bounds.min_y - 0.5) << raw.transpose();
    EXPECT_LE(pixel.y(), bounds.max_y + 0.5) << raw.transpose();
  }
}

TEST(PinholeCamera, BoundsAreHalfOpen) {
  const PinholeCamera::Bounds bounds{.min_x = 0.0, .min_y = -2.0, .max_x = 10.0, .max_y = 5.0};
  EXPECT_TRUE(bounds.Contains({0.0, -2.0}));
  EXPECT_TRUE(bounds.Contains({9.999, 4.999}));
  EXPECT_FALSE(bounds.Contains({10.0, 0.0}));
  EXPECT_FALSE(bounds.Contains({5.0, 5.0}));
  EXPECT_FALSE(bounds.Contains({-0.001, 0.0}));
}

TEST(PinholeCamera, RealCamerasHaveNoFault) {
  EXPECT_EQ(Tum1().FindFault(), "");
  PinholeCamera wide = Tum1();  // strong barrel distortion, as of the cameras of EuRoC
  wide.k1 = -0.28340811;
  wide.k2 = 0.07395907;
  wide.p1 = 0.00019359;
  wide.p2 = 1.76187114e-05;
  wide.k3 = 0.0;
  EXPECT_EQ(wide.FindFault(), "");
}

TEST(PinholeCamera, AFaultNamesTheKey) {
  const auto expect = [](double PinholeCamera::*field, double value, const char* part) {
    PinholeCamera camera = Tum1();
    camera.k1 = camera.k2 = camera.p1 = camera.p2 = camera.k3 = 0.0;
    camera.*field = value;
    EXPECT_NE(camera.FindFault().find(part), std::string::npos)
        << camera.FindFault() << " does not contain " << part;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  expect(&PinholeCamera::fx, 1e-300, "Camera.fx is '1e-300', expected");
  expect(&PinholeCamera::fx, 1e300, "Camera.fx is '1e+300'");
  expect(&PinholeCamera::fy, kNan, "Camera.fy is 'nan'");
  expect(&PinholeCamera::cx, 1e9, "Camera.cx is '1e+09'");
  expect(&PinholeCamera::k2, kNan, "Camera.k2 is 'nan'");
  expect(&PinholeCamera::k1, -5.0, "Camera.k1 is '-5': the distortion cannot be undone");
  expect(&PinholeCamera::k1, -1e300, "Camera.k1 is '-1e+300': the distortion cannot be undone");
  expect(&PinholeCamera::p1, 3.0, "Camera.p1 is '3': the distortion cannot be undone");
  expect(&PinholeCamera::k3, 1e6, "Camera.k3 is '1e+06': the undistorted image would have");
}

TEST(PinholeCamera, BindsTheKeysOfOrbSlam2) {
  PinholeCamera camera;
  OptionTable table;
  camera.Bind(table);
  table.Set("Camera.fx", "535.4", "test");
  table.Set("Camera.k3", "-0.25", "test");
  table.Set("Camera.width", "320", "test");
  table.Set("Camera.bf", "42.5", "test");
  EXPECT_EQ(camera.fx, 535.4);
  EXPECT_EQ(camera.k3, -0.25);
  EXPECT_EQ(camera.width, 320);
  EXPECT_EQ(camera.bf, 42.5);
  for (const char* value : {"0", "-1", "nan", "", "1e999"}) {
    EXPECT_THROW(table.Set("Camera.fx", value, "test"), InputError) << value;
    EXPECT_THROW(table.Set("Camera.fy", value, "test"), InputError) << value;
  }
  EXPECT_THROW(table.Set("Camera.width", "640.5", "test"), InputError);
  EXPECT_THROW(table.Set("Camera.height", "0", "test"), InputError);
}

TEST(Pinhole, TheMatrixProjectsAsProjectDoes) {
  PinholeCamera camera;
  camera.fx = 520.0;
  camera.fy = 510.0;
  camera.cx = 318.0;
  camera.cy = 255.0;
  const Eigen::Vector3d point(0.3, -0.2, 1.7);
  const Eigen::Vector3d pixel = camera.Matrix() * point;
  EXPECT_LT((pixel.hnormalized() - camera.Project(point)).norm(), 1e-12);
}

// Laws of every lens.
class Lens : public testing::TestWithParam<TestCamera> {
 protected:
  const PinholeCamera& camera() const { return GetParam().sensor.camera; }
  // Raw pixels of the image that the lens shows.
  std::vector<Eigen::Vector2d> SeenPixels() const {
    std::vector<Eigen::Vector2d> seen;
    for (const Eigen::Vector2d& raw : PixelsOf(camera())) {
      if (camera().SeesRaw(raw)) {
        seen.push_back(raw);
      }
    }
    return seen;
  }
};

HULLSLAM_WITH_ALL_CAMERAS(Lens);

TEST_P(Lens, HasNoFault) { EXPECT_EQ(camera().FindFault(), ""); }

TEST_P(Lens, APixelComesBackFromItsUndistortedOne) {
  for (const Eigen::Vector2d& raw : SeenPixels()) {
    EXPECT_LT((camera().Distort(camera().Undistort(raw)) - raw).norm(), 1e-6) << raw.transpose();
  }
}

TEST_P(Lens, TheJacobianIsTheSlopeOfTheDistortion) {
  constexpr double kStep = 1e-3;
  for (const Eigen::Vector2d& raw : SeenPixels()) {
    const Eigen::Vector2d pixel = camera().Undistort(raw);
    const Eigen::Matrix2d jacobian = camera().DistortionJacobian(pixel);
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
      const Eigen::Vector2d slope =
          (camera().Distort(pixel + step) - camera().Distort(pixel - step)) / (2.0 * kStep);
      EXPECT_LT((slope - jacobian.col(axis)).norm(), 1e-6) << raw.transpose();
    }
  }
}

TEST_P(Lens, TheImageBeginsAtItsFirstPixelAndEndsBeforeItsSize) {
  EXPECT_TRUE(camera().SeesRaw({0.0, camera().cy}));
  EXPECT_TRUE(camera().SeesRaw({camera().cx, 0.0}));
  EXPECT_TRUE(camera().SeesRaw({639.999, camera().cy}));
  EXPECT_TRUE(camera().SeesRaw({camera().cx, 479.999}));
  EXPECT_FALSE(camera().SeesRaw({640.0, camera().cy}));
  EXPECT_FALSE(camera().SeesRaw({camera().cx, 480.0}));
  EXPECT_FALSE(camera().SeesRaw({-0.001, camera().cy}));
  EXPECT_FALSE(camera().SeesRaw({camera().cx, -0.001}));
}

TEST(IsWide, OnlyALensWhoseImageReachesTheLargestAngleIs) {
  EXPECT_TRUE(FisheyeCamera().IsWide());      // 150 degrees across, more in the corners
  EXPECT_FALSE(PinholeAsFisheye().IsWide());  // a narrow lens in the model of a fisheye
  PinholeCamera brown = PinholeAsFisheye();
  brown.lens = LensModel::kBrown;
  EXPECT_FALSE(brown.IsWide());
}

}  // namespace
}  // namespace hullslam

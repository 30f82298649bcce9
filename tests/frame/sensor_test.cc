// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/sensor.h"

#include <gtest/gtest.h>

#include "hullslam/camera/depth.h"
#include "support/fisheye_camera.h"

namespace hullslam {
namespace {

// The virtual right coordinate of camera/depth.h is the u coordinate of the point in a second
// camera, which is moved along x by the baseline.
TEST(Sensor, BaselineIsThatOfTheVirtualRightCamera) {
  Sensor sensor;
  sensor.camera.fx = 500.0;
  sensor.camera.cx = 320.0;
  sensor.camera.fy = 500.0;
  sensor.camera.bf = 40.0;
  EXPECT_DOUBLE_EQ(sensor.baseline(), 0.08);
  const Eigen::Vector3d in_left(0.3, 0.1, 2.5);
  const Eigen::Vector3d in_right = in_left - Eigen::Vector3d(sensor.baseline(), 0.0, 0.0);
  EXPECT_NEAR(sensor.camera.Project(in_left).x() - sensor.camera.bf / 2.5,
              sensor.camera.Project(in_right).x(), 1e-12);
}

// Pixels are those of the raw image, rounded.
TEST(Sensor, DoesNotSeeWhatTheMaskOfAllImagesIgnores) {
  for (PinholeCamera camera :
       {PinholeCamera{.fx = 300.0, .fy = 300.0, .cx = 320.0, .cy = 240.0}, FisheyeCamera()}) {
    camera.k1 = 0.02;
    Sensor sensor;
    sensor.camera = camera;
    sensor.bounds = camera.UndistortedBounds();
    const Eigen::Vector2d used = camera.Undistort({219.4, 100.0});
    const Eigen::Vector2d ignored = camera.Undistort({219.6, 100.0});
    EXPECT_TRUE(sensor.Sees(used));
    EXPECT_TRUE(sensor.Sees(ignored));
    sensor.mask_all = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
    sensor.mask_all(cv::Rect(220, 0, 100, 480)).setTo(0);
    EXPECT_TRUE(sensor.Sees(used)) << camera.IsFisheye();
    EXPECT_FALSE(sensor.Sees(ignored)) << camera.IsFisheye();
    EXPECT_FALSE(sensor.IsIgnored({-1.0, 100.0}));
    EXPECT_FALSE(sensor.IsIgnored({250.0, 480.0}));
  }
}

// Of a fisheye lens the grid is the raw image.
TEST(Sensor, TheDerivativeOfTheGridIsThatOfItsPixels) {
  for (const PinholeCamera& camera :
       {PinholeCamera{.fx = 300.0, .fy = 300.0, .cx = 320.0, .cy = 240.0, .k1 = 0.1},
        FisheyeCamera()}) {
    Sensor sensor;
    sensor.camera = camera;
    const Eigen::Vector2d pixel = camera.Undistort({480.0, 130.0});
    const Eigen::Vector2d step(0.3, -0.2);
    const Eigen::Vector2d moved =
        0.5 * (sensor.camera.Distort(pixel + step) - sensor.camera.Distort(pixel - step));
    EXPECT_LT((sensor.camera.DistortionJacobian(pixel) * step - moved).norm(), 1e-5);
  }
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/camera_model.h"

#include <gtest/gtest.h>

#include "calibration/made_recording.h"

namespace hullslam {
namespace {

// The middle row is exposed at the time of the pose, the top row half of the readout before.
TEST(CameraModel, ARowSeesThePointWhereItIsAtItsExposure) {
  CameraModel model = MadeCamera();
  model.readout_time = 0.02;
  const PointVelocity velocity{.angular = {0.1, -0.2, 0.3}, .linear = {0.5, -0.4, 0.2}};
  EXPECT_EQ(model.ExposureOf({100.0, 240.0}), 0.0);
  EXPECT_NEAR(model.ExposureOf({100.0, 0.0}), -0.01, 1e-15);
  const Eigen::Vector3d point(0.3, -0.8, 2.0);
  // x(t) = Exp(t w) x + t v, as in frame/rolling_shutter.cc, to the second order.
  const double seconds = -0.008;
  const Eigen::Vector3d exact =
      ExpSo3(seconds * velocity.angular) * point + seconds * velocity.linear;
  EXPECT_LT((MovedPoint(point, velocity, seconds) - exact).norm(), 1e-5);
}

TEST(CameraParameter, MoveGoesBackToTheSameValue) {
  for (const CameraModel& model : MadeCameraModels()) {
    for (const CameraParameter& parameter : ParametersOf(model, {}, true, 300.0)) {
      CameraModel moved = model;
      parameter.Move(3.0, moved);
      EXPECT_NE(parameter.ValueIn(moved), parameter.ValueIn(model)) << parameter.name;
      parameter.Move(-3.0, moved);
      EXPECT_NEAR(parameter.ValueIn(moved), parameter.ValueIn(model), 0.05 * parameter.step)
          << parameter.name;
    }
  }
}

// A step moves pixels near the border by about a pixel, so that all numbers are comparable.
TEST(CameraParameter, AStepOfTheLensIsAboutAPixel) {
  for (const CameraModel& model : MadeCameraModels()) {
    // Of a corner that lies beyond the end of the lens, this is the last pixel.
    const Eigen::Vector3d ray = model.camera.Unproject(model.camera.Undistort({30.0, 25.0}), 1.0);
    const Eigen::Vector2d raw = model.camera.Distort(model.camera.Project(ray));
    for (const CameraParameter& parameter :
         ParametersOf(model, {.readout = false, .disparity = false}, false, 0.0)) {
      CameraModel moved = model;
      parameter.Move(0.1, moved);
      const double change = (moved.camera.Distort(moved.camera.Project(ray)) - raw).norm();
      if (parameter.IsCoefficient() || parameter.unit == "px") {
        EXPECT_GT(change, 0.05) << parameter.name;
        EXPECT_LT(change, 0.2) << parameter.name;
      }
    }
  }
}

}  // namespace
}  // namespace hullslam

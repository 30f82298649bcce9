// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/seen_depths.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/fisheye_camera.h"

namespace hullslam {
namespace {

Sensor MadeSensor() {
  Sensor sensor;
  sensor.bounds = {.min_x = -10.0, .min_y = 0.0, .max_x = 630.0, .max_y = 480.0};
  return sensor;
}

const Sensor kSensor = MadeSensor();

TEST(SeenDepths, AreTheMeansOfCells) {
  SeenDepths seen(kSensor);
  seen.Add({12.0, 10.0}, 2.0);
  seen.Add({20.0, 30.0}, 4.0);
  seen.Add({500.0, 400.0}, 1.0);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt({1.0, 1.0}), (0.5 + 0.25) / 2.0);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt({505.0, 405.0}), 1.0);
}

TEST(SeenDepths, OfAnEmptyCellAreThoseOfTheImage) {
  SeenDepths seen(kSensor);
  EXPECT_EQ(seen.InverseDepthAt({300.0, 200.0}), 0.0);
  seen.Add({12.0, 10.0}, 2.0);
  seen.Add({500.0, 400.0}, 1.0);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt({300.0, 200.0}), 0.75);
}

TEST(SeenDepths, LeaveOutPointsThatAreNotInFrontOfTheCamera) {
  SeenDepths seen(kSensor);
  seen.Add({12.0, 10.0}, 0.0);
  seen.Add({12.0, 10.0}, -1.0);
  EXPECT_EQ(seen.InverseDepthAt({12.0, 10.0}), 0.0);
}

TEST(SeenDepths, TakePixelsOutsideTheImageToBeAtItsBorder) {
  SeenDepths seen(kSensor);
  seen.Add({-50.0, 900.0}, 2.0);
  seen.Add({600.0, 10.0}, 1.0);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt({0.0, 479.0}), 0.5);
}

TEST(SeenDepths, KeypointsOfKnownDepthKeepIt) {
  SeenDepths seen(kSensor);
  seen.Add({100.0, 100.0}, 2.0);
  FrameFeatures features;
  features.keypoints = {{.undistorted = {100.0F, 100.0F}}, {.undistorted = {101.0F, 100.0F}}};
  features.depth = {4.0F, 0.0F};
  EXPECT_EQ(seen.InverseDepths(features), (std::vector<double>{0.25, 0.5}));
}

// The undistorted image of a fisheye lens is so wide that its middle would have very few cells.
TEST(SeenDepths, CellsOfAFisheyeLensAreThoseOfTheRawImage) {
  Sensor sensor;
  sensor.camera = FisheyeCamera();
  sensor.bounds = sensor.camera.UndistortedBounds();
  SeenDepths seen(sensor);
  seen.Add(sensor.camera.Undistort({330.0, 250.0}), 2.0);
  seen.Add(sensor.camera.Undistort({370.0, 250.0}), 4.0);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt(sensor.camera.Undistort({350.0, 270.0})), 0.5);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt(sensor.camera.Undistort({390.0, 270.0})), 0.25);
}

}  // namespace
}  // namespace hullslam

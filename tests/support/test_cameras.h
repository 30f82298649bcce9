// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <ostream>
#include <string>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "support/fisheye_camera.h"
#include "support/synthetic_world.h"

namespace hullslam {

// A camera for tests of behaviour that must be the same for every lens and every source of depth.
struct TestCamera {
  std::string name;
  Sensor sensor;

  friend void PrintTo(const TestCamera& camera, std::ostream* out) { *out << camera.name; }
};

inline Sensor SensorWith(const PinholeCamera& camera) {
  Sensor sensor = SyntheticSensor();
  sensor.camera = camera;
  sensor.bounds = camera.UndistortedBounds();
  sensor.close_depth = 40.0 * sensor.baseline();
  return sensor;
}

// A wide lens in the rational form with all coefficients: its raw corners are 38 px nearer to the
// principal point than those of its undistorted image.
inline PinholeCamera RationalCamera() {
  return {.fx = 500.0,
          .fy = 503.0,
          .cx = 322.0,
          .cy = 238.0,
          .k1 = 0.30,
          .k2 = 0.05,
          .p1 = 0.001,
          .p2 = -0.0008,
          .k3 = 0.002,
          .bf = 40.0,
          .k4 = 0.55,
          .k5 = 0.12,
          .k6 = 0.01};
}

inline TestCamera PinholeTestCamera() { return {"Pinhole", SyntheticSensor()}; }

inline TestCamera FisheyeTestCamera() { return {"Fisheye", SensorWith(FisheyeCamera())}; }

// A camera without distortion, one with, two fisheyes, and a stereo pair. The depths of the others
// are those of depth images.
inline std::vector<TestCamera> TestCameras() {
  TestCamera pair{"Pair", SyntheticSensor()};
  pair.sensor.kind = SensorKind::kStereo;
  return {PinholeTestCamera(),
          {"Rational", SensorWith(RationalCamera())},
          FisheyeTestCamera(),
          {"DoubleSphere", SensorWith(DoubleSphereCamera())},
          pair};
}

inline std::string NameOfCamera(const testing::TestParamInfo<TestCamera>& info) {
  return info.param.name;
}

}  // namespace hullslam

// Runs the TEST_P tests of `suite`, whose parameter is a TestCamera, with all cameras.
#define HULLSLAM_WITH_ALL_CAMERAS(suite)                                               \
  INSTANTIATE_TEST_SUITE_P(Cameras, suite, testing::ValuesIn(hullslam::TestCameras()), \
                           hullslam::NameOfCamera)

// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/calibration_file.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "settings/yaml_map.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// As cv::FileStorage writes it, from OpenCV's calibration sample.
constexpr const char* kOpenCv = R"(%YAML:1.0
---
calibration_time: "Mon"
image_width: 1280
image_height: 720
flags: 16384
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 6.07e+02, 0., 6.402e+02, 0., 6.071e+02, 3.669e+02, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 8
   cols: 1
   dt: d
   data: [ 5.265e-01, -2.6931, 5.6e-04, -1.7e-04, 1.5452, 4.068e-01, -2.5134, 1.4728 ]
)";

constexpr const char* kRos = R"(image_width: 640
image_height: 480
camera_name: narrow
camera_matrix:
  rows: 3
  cols: 3
  data: [500.0, 0.0, 320.5, 0.0, 501.0, 240.5, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.1, 0.02, 0.001, -0.002, 0.003]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
)";

// The camchain of TUM-VI, which has two cameras (shortened numbers).
constexpr const char* kKalibr = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [0.0034823894, 0.000715034845, -0.00205323614, 0.00020293673]
  distortion_model: equidistant
  intrinsics: [190.978477, 190.973307, 254.931706, 256.897442]
  resolution: [512, 512]
  rostopic: /cam0/image_raw
cam1:
  camera_model: pinhole
  distortion_coeffs: [0.1, 0.0, 0.0, 0.0]
  distortion_model: equidistant
  intrinsics: [190.4, 190.4, 252.6, 254.9]
  resolution: [512, 512]
)";

constexpr const char* kStella = R"(Camera:
  name: "a phone"
  setup: "monocular"
  model: "fisheye"
  fx: 200.5
  fy: 201.5
  cx: 320.0
  cy: 240.0
  k1: 0.01
  k2: -0.02
  k3: 0.03
  k4: -0.004
  fps: 25.0
  cols: 640
  rows: 480
  color_order: "RGB"
Feature:
  max_num_keypoints: 2000
)";

std::string With(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

class CalibrationFile : public ::testing::Test {
 protected:
  std::optional<RecognisedCalibration> Read(const std::string& text) {
    folder_.Write("c.yaml", text);
    return RecogniseCalibration(folder_.path() / "c.yaml", ReadYaml(folder_.path() / "c.yaml"));
  }
  void ExpectRefusal(const std::string& text, const std::vector<std::string>& parts) {
    ExpectInputError([&] { Read(text); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(CalibrationFile, OfOpenCv) {
  const auto read = Read(kOpenCv);
  ASSERT_TRUE(read);
  const PinholeCamera& camera = read->calibration.camera;
  EXPECT_EQ(read->program, "a calibration of OpenCV");
  EXPECT_EQ(camera.fx, 607.0);
  EXPECT_EQ(camera.cy, 366.9);
  EXPECT_EQ(camera.width, 1280);
  EXPECT_EQ(camera.p2, -1.7e-4);
  EXPECT_EQ(camera.k4, 0.4068);
  EXPECT_EQ(camera.k6, 1.4728);
  const std::string four = With(
      With(kOpenCv, "[ 5.265e-01, -2.6931, 5.6e-04, -1.7e-04, 1.5452, 4.068e-01, -2.5134, 1.4728 ]",
           "[0.1, 0.2, 0.3, 0.4]"),
      "flags: 16384", "fisheye_model: 1");
  EXPECT_TRUE(Read(four)->calibration.camera.IsFisheye());
  EXPECT_EQ(Read(four)->calibration.camera.k3, 0.3);
  EXPECT_EQ(Read(With(four, "fisheye_model: 1", "fisheye_model: 0"))->calibration.camera.p1, 0.3);
}

// What scripts write: other names, and often no size.
TEST_F(CalibrationFile, OfScripts) {
  const std::string matrices =
      "mtx: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
      "   data: [ 517., 0., 318., 0., 516., 255., 0., 0., 1. ]\n"
      "dist: !!opencv-matrix\n   rows: 1\n   cols: 4\n   dt: d\n   data: [ 0.1, 0., 0., 0. ]\n";
  const PinholeCamera camera =
      Read("%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n" + matrices)->calibration.camera;
  EXPECT_EQ(camera.fx, 517.0);
  EXPECT_EQ(camera.height, 480);
  ExpectRefusal("%YAML:1.0\n---\n" + matrices, {"c.yaml:3: mtx", "image_width"});
}

TEST_F(CalibrationFile, OfRos) {
  const auto read = Read(kRos);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->program, "a camera_info of ROS");
  EXPECT_EQ(read->calibration.camera.fy, 501.0);
  EXPECT_EQ(read->calibration.camera.k3, 0.003);
  EXPECT_EQ(read->calibration.camera.height, 480);
}

TEST_F(CalibrationFile, OfKalibrAndTumVi) {
  const auto read = Read(kKalibr);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->program, "a camchain of Kalibr, camera cam0 of 2");
  EXPECT_TRUE(read->calibration.camera.IsFisheye());
  EXPECT_EQ(read->calibration.camera.k4, 0.00020293673);
  EXPECT_EQ(read->calibration.camera.cx, 254.931706);
  EXPECT_EQ(read->calibration.camera.FindFault(), "");
}

TEST_F(CalibrationFile, OfStellaInBothForms) {
  const auto nested = Read(kStella);
  ASSERT_TRUE(nested);
  EXPECT_NE(nested->program.find("stella_vslam"), std::string::npos);
  EXPECT_TRUE(nested->calibration.camera.IsFisheye());
  EXPECT_EQ(nested->calibration.camera.k4, -0.004);
  EXPECT_EQ(nested->calibration.frames_per_second, 25.0);
  const auto flat = Read(
      "Camera.model: \"perspective\"\nCamera.fx: 458.0\nCamera.fy: 457.0\nCamera.cx: 367.0\n"
      "Camera.cy: 248.0\nCamera.k1: -0.28\nCamera.k2: 0.07\nCamera.p1: 0.001\nCamera.p2: 0.002\n"
      "Camera.k3: 0.0\nCamera.cols: 752\nCamera.rows: 480\nCamera.focal_x_baseline: 47.9\n");
  ASSERT_TRUE(flat);
  EXPECT_EQ(flat->calibration.camera.p1, 0.001);
  EXPECT_EQ(flat->calibration.camera.width, 752);
  EXPECT_EQ(flat->calibration.camera.bf, 47.9);
}

TEST_F(CalibrationFile, OfTumVisSensor) {
  const auto read = Read(
      "sensor_type: camera\nrate_hz: 20\nresolution: [512, 512]\ncamera_model: pinhole\n"
      "intrinsics: [190.9, 190.9, 254.9, 256.9]\ndistortion_model: equidistant\n"
      "distortion_coefficients: [0.003, 0.0007, -0.002, 0.0002]\n");
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->calibration.camera.IsFisheye());
  EXPECT_EQ(read->calibration.frames_per_second, 20.0);
}

TEST_F(CalibrationFile, OfCamodocal) {
  const std::string head =
      "%YAML:1.0\n---\nmodel_type: PINHOLE\ncamera_name: camera\nimage_width: 640\n"
      "image_height: 480\n";
  const auto pinhole =
      Read(head +
           "distortion_parameters:\n   k1: 0.1\n   k2: -0.2\n   p1: 0.001\n   p2: 0.002\n"
           "projection_parameters:\n   fx: 517.3\n   fy: 516.5\n   cx: 318.6\n   cy: 255.3\n");
  ASSERT_TRUE(pinhole);
  EXPECT_EQ(pinhole->program, "a calibration of camodocal");
  EXPECT_EQ(pinhole->calibration.camera.fy, 516.5);
  EXPECT_EQ(pinhole->calibration.camera.p2, 0.002);
  EXPECT_EQ(pinhole->calibration.camera.height, 480);
  const std::string fisheye_text =
      With(head, "PINHOLE", "KANNALA_BRANDT") +
      "projection_parameters:\n   k2: 0.01\n   k3: 0.02\n   k4: 0.03\n   k5: 0.04\n   mu: 190\n"
      "   mv: 191\n   u0: 320\n   v0: 240\n";
  const auto fisheye = Read(fisheye_text);
  ASSERT_TRUE(fisheye);
  EXPECT_TRUE(fisheye->calibration.camera.IsFisheye());
  EXPECT_EQ(fisheye->calibration.camera.k1, 0.01);
  EXPECT_EQ(fisheye->calibration.camera.k4, 0.04);
  EXPECT_EQ(fisheye->calibration.camera.cy, 240.0);
  ExpectRefusal(With(fisheye_text, "KANNALA_BRANDT", "MEI"),
                {"c.yaml:3: model_type is 'MEI'", "expected PINHOLE or KANNALA_BRANDT"});
  ExpectRefusal(With(fisheye_text, "   mv: 191\n", ""), {"projection_parameters.mv is not given"});
}

TEST_F(CalibrationFile, WhatLacksSomethingIsNamedWithAWayOut) {
  ExpectRefusal(
      "M1: [500, 0, 320, 0, 500, 240, 0, 0, 1]\nD1: [0, 0, 0, 0]\nM2: [1]\nT: [-0.1, 0, 0]\n",
      {"c.yaml:1: M1", "a stereo calibration of OpenCV", "size", "LEFT.K", "Kalibr"});
  ExpectRefusal("[LEFT_CAM_VGA]\nfx=261.4\nfy=261.4\n[STEREO]\nBaseline=120.006\n",
                {"c.yaml", "ZED SDK", "Camera.bf"});
}

TEST_F(CalibrationFile, SettingsAreNone) {
  EXPECT_FALSE(Read("%YAML:1.0\nCamera.fx: 500\nCamera.type: \"PinHole\"\n"));
  EXPECT_FALSE(Read(""));
}

TEST_F(CalibrationFile, BrokenFilesAreRefusedWithLineAndKey) {
  ExpectRefusal(With(kOpenCv, "image_width: 1280", ""),
                {"c.yaml:7: camera_matrix", "does not tell the size", "image_width: 640"});
  ExpectRefusal(With(kOpenCv, "image_width: 1280", "image_width: 0.5"),
                {"c.yaml:4: image_width", "a number of pixels"});
  ExpectRefusal(With(kOpenCv, "0., 0., 1. ]", "0., 0. ]"),
                {"camera_matrix.data has 8 value(s), expected 9"});
  ExpectRefusal(With(kOpenCv, "6.07e+02, 0.,", "6.07e+02, 3.,"),
                {"c.yaml:7: camera_matrix is no matrix"});
  ExpectRefusal(With(kOpenCv, "[ 5.265e-01, -2.6931,", "[ 5.265e-01 ]\nrest: [ -2.6931,"),
                {"distortion_coefficients is 'opencv' with 1 number(s), expected 4 to 8"});
  ExpectRefusal(With(kRos, "plumb_bob", "thin_prism"),
                {"c.yaml:8: distortion_model is 'thin_prism' with 5", "expected plumb_bob"});
  ExpectRefusal(With(kRos, "data: [500.0,", "data: [.nan,"), {"camera_matrix.data"});
  ExpectRefusal(With(kKalibr, "pinhole", "omni"),
                {"c.yaml:3: cam0.camera_model is 'omni', expected 'pinhole'"});
  ExpectRefusal(With(kKalibr, "-0.00205323614, 0.00020293673", "1"),
                {"c.yaml:5: cam0.distortion_model is 'equidistant'", "3 number(s), expected 4"});
  ExpectRefusal(With(kKalibr, "intrinsics: [190.978477, ", "intrinsics: ["),
                {"cam0.intrinsics has 3 value(s), expected 4"});
  ExpectRefusal(With(kStella, "fisheye", "equirectangular"),
                {"c.yaml:4: Camera.model is 'equirectangular'", "perspective or fisheye"});
  ExpectRefusal(With(kStella, "  k4: -0.004\n", ""), {"Camera.k4 is not given"});
  ExpectRefusal("cam0: 5\n", {"c.yaml:1: cam0 is not a map"});
  ExpectRefusal("camera_matrix: 5\n", {"camera_matrix is not a map"});
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/euroc_sequence.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// The camera is turned by 90 degrees about z and lies at (0.1, 0.2, 0.3) in the body.
const std::string kSensor =
    "# General sensor definitions.\n"
    "sensor_type: camera\n"
    "comment: VI-Sensor cam0 (MT9M034)\n"
    "\n"
    "# Sensor extrinsics wrt. the body-frame.\n"
    "T_BS:\n"
    "  cols: 4\n"
    "  rows: 4\n"
    "  data: [0.0, -1.0, 0.0, 0.1,\n"
    "         1.0, 0.0, 0.0, 0.2,\n"
    "         0.0, 0.0, 1.0, 0.3,\n"
    "         0.0, 0.0, 0.0, 1.0]\n"
    "\n"
    "rate_hz: 20\n"
    "resolution: [752, 480]\n"
    "camera_model: pinhole\n"
    "intrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv\n"
    "distortion_model: radial-tangential\n"
    "distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n";

std::string Replace(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

class EurocSequenceTest : public ::testing::Test {
 protected:
  EurocSequenceTest() {
    for (const char* const name : {"10", "11", "12"}) {
      folder_.Write(std::string("mav0/cam0/data/14000000") + name + "500000000.png", "");
    }
    WriteList("");
    WriteSensor(kSensor);
  }

  void WriteSensor(const std::string& text) { folder_.Write("mav0/cam0/sensor.yaml", text); }
  // Three good lines, in lines 2 to 4, and then `more`.
  void WriteList(const std::string& more) {
    folder_.Write("mav0/cam0/data.csv",
                  "#timestamp [ns],filename\r\n1400000010500000000,1400000010500000000.png\r\n"
                  "1400000011500000000,1400000011500000000.png\r\n"
                  "1400000012500000000,1400000012500000000.png\r\n" +
                      more);
  }
  void WriteStates(const std::string& lines) {
    folder_.Write("mav0/state_groundtruth_estimate0/data.csv",
                  "#timestamp, p_RS_R_x [m], p_RS_R_y [m], ...\n" + lines);
  }
  EurocSequence Open(const FrameSelection& selection = {}) {
    return OpenEurocSequence(folder_.path(), selection);
  }
  void ExpectWarning(const std::vector<std::string>& parts) {
    const ImageSequence images = Open().images;
    EXPECT_FALSE(images.converted_groundtruth.has_value());
    ASSERT_EQ(images.warnings.size(), 1U);
    for (const std::string& part : parts) {
      EXPECT_NE(images.warnings[0].find(part), std::string::npos) << images.warnings[0];
    }
  }
  void ExpectError(const std::vector<std::string>& parts) {
    ExpectInputError([&] { Open(); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(EurocSequenceTest, ListsTheImagesOfTheLeftCamera) {
  const EurocSequence sequence = Open();
  ASSERT_EQ(sequence.images.frames.size(), 3U);
  EXPECT_EQ(sequence.images.frames[1].timestamp, 1400000011.5);
  EXPECT_EQ(sequence.images.frames[1].image,
            folder_.path() / "mav0/cam0/data/1400000011500000000.png");
  EXPECT_TRUE(sequence.images.frames[1].depth.empty());
  EXPECT_FALSE(sequence.images.converted_groundtruth.has_value());
  EXPECT_EQ(OpenEurocSequence(folder_.path() / "mav0").images.frames.size(), 3U);
  EXPECT_EQ(Open({.first = 1, .last = 1}).images.frames.front().number, 1U);
}

class EurocPairsTest : public EurocSequenceTest {
 protected:
  // The right camera has the same directions and is 0.11 m to the right, which is along y of the
  // body.
  EurocPairsTest() {
    WriteRight({"1400000010500000000", "1400000011500000000", "1400000012500000000"});
    folder_.Write("mav0/cam1/sensor.yaml", Replace(kSensor, "0.0, 0.0, 0.2", "0.0, 0.0, 0.31"));
  }
  void WriteRight(const std::vector<std::string>& stamps) {
    std::string list = "#timestamp [ns],filename\n";
    for (const std::string& stamp : stamps) {
      list += stamp + "," + stamp + ".png\n";
      folder_.Write("mav0/cam1/data/" + stamp + ".png", "");
    }
    folder_.Write("mav0/cam1/data.csv", list);
  }
};

TEST_F(EurocPairsTest, BothCamerasAreReadAndRectified) {
  WriteStates("1400000010500000000,1,2,3,1,0,0,0\n");
  const StereoSequence sequence = OpenEurocPairs(folder_.path());
  ASSERT_EQ(sequence.images.frames.size(), 3u);
  EXPECT_EQ(sequence.images.frames[2].right,
            folder_.path() / "mav0/cam1/data/1400000012500000000.png");
  const PinholeCamera& camera = sequence.calibration.camera;
  EXPECT_NEAR(camera.bf / camera.fx, 0.11, 1e-9);
  EXPECT_FALSE(camera.IsDistorted());
  const Rigid3 pose = sequence.images.converted_groundtruth->front().world_from_cam;
  EXPECT_TRUE(pose.translation.isApprox(Eigen::Vector3d(1.1, 2.2, 3.3), 1e-9))
      << "the rectified camera has the centre of the left one";
}

// The layout of TUM-VI: one camchain of Kalibr, and the ground truth of a motion capture system.
// The cameras look along x of the body, 0.1 m apart.
constexpr const char* kCamchain =
    "cam0:\n"
    "  T_cam_imu:\n  - [0.0, -1.0, 0.0, 0.1]\n  - [0.0, 0.0, -1.0, 0.2]\n"
    "  - [1.0, 0.0, 0.0, 0.3]\n  - [0.0, 0.0, 0.0, 1.0]\n"
    "  camera_model: pinhole\n"
    "  distortion_coeffs: [0.0034823894, 0.0007150348, -0.0020532361, 0.0002029367]\n"
    "  distortion_model: equidistant\n"
    "  intrinsics: [190.97847715, 190.9733070521, 254.931706, 256.8974428]\n"
    "  resolution: [512, 512]\n"
    "cam1:\n"
    "  T_cn_cnm1:\n  - [1.0, 0.0, 0.0, -0.1]\n  - [0.0, 1.0, 0.0, 0.0]\n"
    "  - [0.0, 0.0, 1.0, 0.0]\n  - [0.0, 0.0, 0.0, 1.0]\n"
    "  camera_model: pinhole\n"
    "  distortion_coeffs: [0.0034003171, 0.0017662782, -0.0026631257, 0.0003299517]\n"
    "  distortion_model: equidistant\n"
    "  intrinsics: [190.4423676, 190.4344384, 252.5999, 254.917239]\n"
    "  resolution: [512, 512]\n";

class TumViTest : public EurocPairsTest {
 protected:
  TumViTest() {
    std::filesystem::remove(folder_.path() / "mav0/cam0/sensor.yaml");
    std::filesystem::remove(folder_.path() / "mav0/cam1/sensor.yaml");
    folder_.Write("mav0/mocap0/data.csv", "#timestamp [ns]\n1400000010500000000,1,2,3,1,0,0,0\n");
  }
};

TEST_F(TumViTest, TheCamchainGivesTheCameras) {
  folder_.Write("dso/camchain.yaml", kCamchain);
  const EurocSequence left = Open();
  const EurocCamera camera = left.camera.value();
  EXPECT_TRUE(camera.calibration.camera.IsFisheye());
  EXPECT_EQ(camera.calibration.camera.k4, 0.0002029367);
  EXPECT_EQ(camera.calibration.frames_per_second, 1.0) << "by the stamps";
  EXPECT_NE(left.calibration.find("dso/camchain.yaml"), std::string::npos);
  const Rigid3 pose = left.images.converted_groundtruth.value().front().world_from_cam;
  EXPECT_TRUE((pose * Eigen::Vector3d(0.1, 0.2, 0.3)).isApprox(Eigen::Vector3d(1.0, 2.0, 3.0)));

  const StereoSequence pairs = OpenEurocPairs(folder_.path());
  const PinholeCamera& rectified = pairs.calibration.camera;
  EXPECT_NEAR(rectified.bf / rectified.fx, 0.1, 1e-9);
  EXPECT_FALSE(rectified.IsDistorted());
  EXPECT_EQ(rectified.width, 512);
  EXPECT_TRUE(pairs.images.converted_groundtruth.has_value());
}

TEST_F(TumViTest, BrokenCamchainsAreReported) {
  const auto expect = [&](const std::string& from, const std::string& to,
                          const std::vector<std::string>& parts) {
    folder_.Write("dso/camchain.yaml", Replace(kCamchain, from, to));
    ExpectInputError([&] { OpenEurocPairs(folder_.path()); }, parts);
  };
  expect("cam1:", "cam2:", {"camchain.yaml: cam1 is not given"});
  expect("  - [1.0, 0.0, 0.0, -0.1]\n", "", {"cam1.T_cn_cnm1 has 12 numbers, expected 16"});
  expect("  - [1.0, 0.0, 0.0, -0.1]\n", "  - [2.0, 0.0, 0.0, -0.1]\n",
         {"cam1.T_cn_cnm1 is not a rigid transform"});
  expect("  - [1.0, 0.0, 0.0, -0.1]\n", "  - [1.0, 0.0, 0.0, x]\n", {"cam1.T_cn_cnm1", "'x'"});
  expect("T_cn_cnm1", "T_other", {"cam1.T_cn_cnm1 is not given"});
  expect("-0.0026631257", "-2.6631257", {"the right camera: Camera.k3 is '-2.66", "folds"});
  expect(", 0.0003299517]", "]", {"cam1.distortion_model is 'equidistant'", "3 number(s)"});
  expect(", 0.0003299517]", ", .nan]", {"cam1.distortion_coeffs", "'.nan'"});
}

TEST_F(TumViTest, WithoutCalibrationThereIsNoCameraAndNoTruth) {
  const EurocSequence left = Open();
  EXPECT_FALSE(left.camera.has_value());
  ExpectWarning({"mocap0/data.csv", "no calibration", "without ground truth"});
  ExpectInputError([&] { OpenEurocPairs(folder_.path()); },
                   {"neither cam0/sensor.yaml nor a camchain"});
}

TEST_F(EurocPairsTest, ImagesWithoutPartnerAreLeftOutOrRefused) {
  WriteRight({"1400000010500000000", "1400000012501000000"});
  const StereoSequence sequence = OpenEurocPairs(folder_.path());
  EXPECT_EQ(sequence.images.frames.size(), 2u);
  ASSERT_EQ(sequence.images.warnings.size(), 1u);
  EXPECT_NE(sequence.images.warnings[0].find("1 of 3 images"), std::string::npos);
  WriteRight({"1400000010530000000", "1400000011530000000", "1400000012530000000"});
  ExpectInputError([&] { OpenEurocPairs(folder_.path()); },
                   {"0 of 3 images", "2.5 ms", "synchronised"});
}

TEST_F(EurocPairsTest, CamerasThatAreNoPairAreRefused) {
  const auto expect = [&](const std::string& sensor, const std::vector<std::string>& parts) {
    folder_.Write("mav0/cam1/sensor.yaml", sensor);
    ExpectInputError([&] { OpenEurocPairs(folder_.path()); }, parts);
  };
  expect(kSensor, {"the baseline is 0 m"});
  expect(Replace(kSensor, "0.0, 0.0, 0.2", "0.0, 0.0, 0.1"), {"swapped"});
  expect(Replace(kSensor, "[752, 480]", "[640, 480]"), {"equal sizes"});
}

TEST_F(EurocSequenceTest, TheSensorFileGivesTheCamera) {
  const EurocCamera read = Open().camera.value();
  const PinholeCamera& camera = read.calibration.camera;
  EXPECT_EQ(camera.Matrix()(0, 0), 458.654);
  EXPECT_EQ(camera.Matrix()(1, 1), 457.296);
  EXPECT_EQ(camera.Matrix()(0, 2), 367.215);
  EXPECT_EQ(camera.Matrix()(1, 2), 248.375);
  EXPECT_EQ(camera.k1, -0.28340811);
  EXPECT_EQ(camera.k2, 0.07395907);
  EXPECT_EQ(camera.p1, 0.00019359);
  EXPECT_EQ(camera.p2, 1.76187114e-05);
  EXPECT_EQ(camera.k3, 0.0);
  EXPECT_EQ(camera.width, 752);
  EXPECT_EQ(camera.height, 480);
  EXPECT_EQ(read.calibration.frames_per_second, 20.0);
  EXPECT_TRUE((read.body_from_cam * Eigen::Vector3d(1.0, 0.0, 2.0))
                  .isApprox(Eigen::Vector3d(0.1, 1.2, 2.3), 1e-12));
}

TEST_F(EurocSequenceTest, TheGroundTruthOfTheBodyBecomesThatOfTheCamera) {
  // The body is turned by 180 degrees about x: q = (0, 1, 0, 0) with w first.
  WriteStates(
      "1400000010500000000,1,2,3,0,1,0,0,0,0,0,0,0,0,0,0,0\n1400000010505000000,0,0,0,1,0,0,0\n");
  const Trajectory poses = Open().images.converted_groundtruth.value();
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_NEAR(poses[1].timestamp - poses[0].timestamp, 0.005, 1e-6);
  EXPECT_TRUE(poses[0].world_from_cam.translation.isApprox(Eigen::Vector3d(1.1, 1.8, 2.7), 1e-12));
  // A point ahead of the camera is ahead of the body (z), which looks down in the world.
  EXPECT_TRUE((poses[0].world_from_cam * Eigen::Vector3d(0.0, 0.0, 1.0))
                  .isApprox(Eigen::Vector3d(1.1, 1.8, 1.7), 1e-12));
}

// SLAM needs no ground truth.
TEST_F(EurocSequenceTest, BrokenStatesAreReportedButDoNotEndARun) {
  const auto expect = [&](const std::string& line, const std::vector<std::string>& parts) {
    WriteStates("1400000010500000000,1,2,3,1,0,0,0\n" + line + '\n');
    ExpectWarning(parts);
  };
  expect("1400000010600000000,1,2,3,1,0,0", {"data.csv:3: ", "7 column(s), expected 8"});
  expect("1400000010600000000,1,x,3,1,0,0,0", {"data.csv:3: ", "p_y is 'x'"});
  expect("1400000010600000000,1,2,3,0,0,0,0", {"data.csv:3: ", "quaternion has length 0"});
  expect("1400000010500000000,1,2,3,1,0,0,0", {"data.csv:3: ", "does not come after"});
  expect("1.5,1,2,3,1,0,0,0", {"data.csv:3: ", "'1.5'", "nanoseconds"});
  WriteStates("");
  ExpectWarning({"state_groundtruth_estimate0/data.csv", "has no poses"});
}

TEST_F(EurocSequenceTest, BrokenListsAreReported) {
  const auto expect = [&](const std::string& line, const std::vector<std::string>& parts) {
    WriteList(line + '\n');
    ExpectError(parts);
  };
  expect("1400000013500000000", {"cam0/data.csv:5: ", "1 column(s), expected 2"});
  expect("1400000013500000000,a.png,7", {"cam0/data.csv:5: ", "3 column(s), expected 2"});
  expect("1400000011500000000,a.png", {"cam0/data.csv:5: ", "does not come after"});
  expect("1400000013.5,a.png", {"cam0/data.csv:5: ", "'1400000013.5'", "nanoseconds"});
  expect("-5,a.png", {"cam0/data.csv:5: ", "'-5'"});
  expect("99999999999999999999999,a.png", {"cam0/data.csv:5: ", "nanoseconds"});
  expect("1400000013500000000,a.png", {"cam0/data/a.png: the image is missing"});
  folder_.Write("mav0/cam0/data.csv", "#timestamp [ns],filename\n");
  ExpectError({"cam0/data.csv", "has no images"});
}

TEST_F(EurocSequenceTest, MissingFilesAreReported) {
  std::filesystem::remove(folder_.path() / "mav0/cam0/data.csv");
  ExpectError({"cam0/data.csv", "No such file"});
  const TemporaryFolder empty;
  ExpectInputError([&] { OpenEurocSequence(empty.path()); },
                   {empty.path().string(), "has no folder mav0/cam0", "EuRoC"});
}

TEST_F(EurocSequenceTest, BrokenSensorFilesAreReported) {
  const auto expect = [&](const std::string& from, const std::string& to,
                          const std::vector<std::string>& parts) {
    WriteSensor(Replace(kSensor, from, to));
    ExpectError(parts);
  };
  expect("intrinsics:", "intrinsic:", {"sensor.yaml: intrinsics is not given"});
  expect("[458.654, 457.296, 367.215, 248.375]", "[458.654, 457.296, 367.215]",
         {"sensor.yaml:17: intrinsics has 3 value(s), expected 4 numbers: fu fv cu cv"});
  expect("[458.654,", "[wide,", {"sensor.yaml:17: intrinsics has a value that is not a number"});
  expect("[458.654,", "[-458.654,", {"sensor.yaml: Camera.fx is '-458.654'"});
  expect("[-0.28340811,", "[-28.340811,", {"sensor.yaml: Camera.k1 is '-28.3408'"});
  expect("[752, 480]", "[752.5, 480]", {"sensor.yaml:15: resolution has the value '752.5'"});
  expect("[752, 480]", "[752, 0]", {"sensor.yaml:15: resolution has the value '0'"});
  expect("rate_hz: 20", "rate_hz: 0", {"sensor.yaml: Camera.fps is '0'"});
  expect("rate_hz: 20", "rate_hz: often", {"sensor.yaml:14: rate_hz has a value"});
  expect("camera_model: pinhole", "camera_model: omni",
         {"sensor.yaml:16: camera_model is 'omni', expected 'pinhole'"});
  expect("radial-tangential", "omni", {"sensor.yaml:18: distortion_model is 'omni'"});
  expect("0.0, -1.0, 0.0, 0.1", "0.0, 1.0, 0.0, 0.1", {"sensor.yaml:6: T_BS is not a rigid"});
  expect("0.0, 0.0, 0.0, 1.0]", "0.0, 0.0, 0.0, 2.0]", {"sensor.yaml:6: T_BS is not a rigid"});
  expect("0.0, 0.0, 0.0, 1.0]", "0.0]", {"sensor.yaml:9: T_BS.data has 13 value(s), expected 16"});
  expect("  data:", "  dates:", {"T_BS.data is not given"});
  expect("resolution: [752, 480]", "resolution: [752, 480", {"sensor.yaml:"});
  WriteSensor("");
  ExpectError({"sensor.yaml"});
}

}  // namespace
}  // namespace hullslam

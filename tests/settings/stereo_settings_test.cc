// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/stereo_settings.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "hullslam/settings/settings.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// The pair of EuRoC in the forms of ORB-SLAM2 (shortened numbers) and of ORB-SLAM3.
constexpr const char* kOrb2 = R"(%YAML:1.0
Camera.fx: 435.2
Camera.fy: 435.2
Camera.cx: 367.4
Camera.cy: 252.2
Camera.width: 752
Camera.height: 480
Camera.bf: 47.9
LEFT.width: 752
LEFT.height: 480
LEFT.D: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data:[-0.2834, 0.0739, 0.00019, 1.76e-05, 0.0]
LEFT.K: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [458.654, 0.0, 367.215, 0.0, 457.296, 248.375, 0.0, 0.0, 1.0]
LEFT.R:  !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [0.999966347530033, -0.001422739138722922, 0.008079580483432283, 0.001365741834644127, 0.9999741760894847, 0.007055629199258132, -0.008089410156878961, -0.007044357138835809, 0.9999424675829176]
RIGHT.height: 480
RIGHT.width: 752
RIGHT.D: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data:[-0.28368365, 0.07451284, -0.00010473, -3.555e-05, 0.0]
RIGHT.K: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [457.587, 0.0, 379.999, 0.0, 456.134, 255.238, 0.0, 0.0, 1]
RIGHT.R:  !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [0.9999633526194376, -0.003625811871560086, 0.007755443660172947, 0.003680398547259526, 0.9999684752771629, -0.007035845251224894, -0.007729688520722713, 0.007064130529506649, 0.999945173484644]
RIGHT.P:  !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [435.2046959714599, 0, 367.4517211914062, -47.90639384423901, 0, 435.2046959714599, 252.2008514404297, 0, 0, 0, 1, 0]
)";

class StereoSettings : public ::testing::Test {
 protected:
  std::shared_ptr<const StereoRectifier> Read(const std::string& text) {
    const auto file = folder_.Write("c.yaml", text);
    return MakeRectifier(file, ReadSettings(file).camera);
  }
  static std::string Replaced(const std::string& from, const std::string& to) {
    std::string text = kOrb2;
    return text.replace(text.find(from), from.size(), to);
  }

  TemporaryFolder folder_;
};

TEST_F(StereoSettings, FilesOfOrbSlam2AreRead) {
  const auto rectifier = Read(kOrb2);
  ASSERT_NE(rectifier, nullptr);
  EXPECT_NEAR(rectifier->camera().bf / rectifier->camera().fx, 0.11008, 1e-4);
  EXPECT_FALSE(rectifier->camera().IsDistorted());
  const Eigen::Matrix3d rotation = rectifier->rectified_from_left().rotation.toRotationMatrix();
  EXPECT_NEAR(rotation(0, 2), 0.008079580483432283, 1e-4) << "LEFT.R";
  EXPECT_NEAR(rotation(2, 1), -0.007044357138835809, 1e-4);
}

TEST_F(StereoSettings, FilesOfOrbSlam3AreRead) {
  const auto rectifier = Read(
      "File.version: \"1.0\"\nCamera.type: \"PinHole\"\nCamera1.fx: 458.654\nCamera1.fy: 457.296\n"
      "Camera1.cx: 367.215\nCamera1.cy: 248.375\nCamera1.k1: -0.28340811\nCamera1.k2: 0.07395907\n"
      "Camera2.fx: 457.587\nCamera2.fy: 456.134\nCamera2.cx: 379.999\nCamera2.cy: 255.238\n"
      "Camera2.k1: -0.28368365\nCamera2.k2: 0.07451284\nCamera.width: 752\nCamera.height: 480\n"
      "Stereo.ThDepth: 60.0\nStereo.T_c1_c2: !!opencv-matrix\n  rows: 4\n  cols: 4\n  dt: f\n"
      "  data: [0.999997256477797,-0.002317135723275,-0.000343393120620,0.110074137800478,\n"
      "         0.002312067192432,0.999898048507103,-0.014090668452683,-0.000156612054392,\n"
      "         0.000376008102320,0.014089835846691,0.999900662638081,0.000889382785432,\n"
      "         0,0,0,1.0]\n");
  ASSERT_NE(rectifier, nullptr);
  EXPECT_NEAR(rectifier->camera().bf / rectifier->camera().fx, 0.11008, 1e-4);
}

// Its files before format 1.0 have the pose of the right camera in Tlr, and keys for the overlap.
TEST_F(StereoSettings, FormerFilesOfOrbSlam3AreRead) {
  const auto rectifier = Read(
      "%YAML:1.0\nCamera.type: \"KannalaBrandt8\"\nCamera.fx: 261.4\nCamera.fy: 261.4\n"
      "Camera.cx: 334.8\nCamera.cy: 188.8\nCamera.k1: 0.001\nCamera.k2: 0.0\nCamera.k3: 0.0\n"
      "Camera.k4: 0.0\nCamera2.fx: 261.4\nCamera2.fy: 261.4\nCamera2.cx: 334.8\nCamera2.cy: 188.8\n"
      "Camera2.k1: 0.001\nCamera2.k2: 0.0\nCamera2.k3: 0.0\nCamera2.k4: 0.0\n"
      "Camera.lappingBegin: 0\nCamera.lappingEnd: 671\nCamera2.lappingBegin: 0\n"
      "Camera2.lappingEnd: 671\nCamera.bFishEye: 0\nTlr: !!opencv-matrix\n  rows: 3\n  cols: 4\n"
      "  dt: f\n  data: [1, 0, 0, 0.12, 0, 1, 0, 0, 0, 0, 1, 0]\nCamera.width: 672\n"
      "Camera.height: 376\nCamera.bf: 31.4\n");
  ASSERT_NE(rectifier, nullptr);
  EXPECT_NEAR(rectifier->camera().bf / rectifier->camera().fx, 0.12, 1e-9);
}

TEST_F(StereoSettings, ARectifiedCameraNeedsNone) {
  EXPECT_EQ(Read("Camera.fx: 500\nCamera.fy: 500\nCamera.cx: 320\nCamera.cy: 240\n"), nullptr);
}

// The pair above in the files that ROS's camera_calibration writes.
std::string InfoOf(const std::string& camera, const std::string& distortion,
                   const std::string& rectification, const std::string& fourth) {
  return "image_width: 752\nimage_height: 480\ncamera_name: narrow_stereo\ncamera_matrix:\n"
         "  rows: 3\n  cols: 3\n  data: [" +
         camera +
         "]\ndistortion_model: plumb_bob\n"
         "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [" +
         distortion +
         "]\n"
         "rectification_matrix:\n  rows: 3\n  cols: 3\n  data: [" +
         rectification +
         "]\n"
         "projection_matrix:\n  rows: 3\n  cols: 4\n"
         "  data: [435.2, 0, 367.4, " +
         fourth + ", 0, 435.2, 252.2, 0, 0, 0, 1, 0]\n";
}

TEST_F(StereoSettings, TheCameraInfosOfRosAreAPair) {
  const auto left = folder_.Write(
      "left.yaml",
      InfoOf(
          "458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1", "-0.2834, 0.0739, 0.00019, 0, 0",
          "0.999966347530033, -0.001422739138722922, 0.008079580483432283, 0.001365741834644127, "
          "0.9999741760894847, 0.007055629199258132, -0.008089410156878961, "
          "-0.007044357138835809, 0.9999424675829176",
          "0"));
  const auto read = [&] { return MakeRectifier(left, ReadSettings(left).camera); };
  EXPECT_TRUE(HasRightCamera(left));
  ExpectInputError(read, {"left.yaml:17: projection_matrix is of the left camera", "right.yaml"});
  const std::string right =
      InfoOf("457.587, 0, 379.999, 0, 456.134, 255.238, 0, 0, 1", "-0.28368, 0.0745, -0.0001, 0, 0",
             "0.9999633526194376, -0.003625811871560086, 0.007755443660172947, "
             "0.003680398547259526, 0.9999684752771629, -0.007035845251224894, "
             "-0.007729688520722713, 0.007064130529506649, 0.999945173484644",
             "-47.90639384423901");
  folder_.Write("right.yaml", right);
  const auto rectifier = read();
  ASSERT_NE(rectifier, nullptr);
  EXPECT_NEAR(rectifier->camera().bf / rectifier->camera().fx, 0.11008, 1e-4);
  EXPECT_NEAR(rectifier->rectified_from_left().rotation.toRotationMatrix()(0, 2), 0.00808, 1e-4);

  folder_.Write("right.yaml", "image_width: 752\n");
  ExpectInputError(read, {"right.yaml", "camera_matrix is not given"});
  folder_.Write("right.yaml", "rectification_matrix: 1\n" + right.substr(0, right.find("rectif")));
  ExpectInputError(read, {"right.yaml", "rectification_matrix"});
}

// A camera_info of one camera whose name tells no side.
TEST_F(StereoSettings, TheCameraInfoOfOneCameraIsNone) {
  const auto file =
      folder_.Write("head.yaml", InfoOf("458, 0, 367, 0, 457, 248, 0, 0, 1", "0, 0, 0, 0, 0",
                                        "1, 0, 0, 0, 1, 0, 0, 0, 1", "0"));
  EXPECT_FALSE(HasRightCamera(file));
}

TEST_F(StereoSettings, BrokenFilesAreRefusedWithLineAndKey) {
  const auto expect = [&](const std::string& text, const std::vector<std::string>& parts) {
    ExpectInputError([&] { Read(text); }, parts);
  };
  expect(Replaced("LEFT.K: ", "LEFT.L: "), {"c.yaml", "LEFT.K is not given"});
  expect(Replaced("458.654, 0.0, ", "458.654, "), {"c.yaml", "LEFT.K.data has 8 value(s)"});
  expect(Replaced("0.999966347530033", "0.5"), {"c.yaml:21: LEFT.R is no rotation"});
  expect(Replaced("-47.90639384423901", "47.9"), {"to the left of the first one"});
  expect(Replaced("-47.90639384423901", "0"), {"the baseline is 0 m"});
  expect(Replaced("RIGHT.width: 752", "RIGHT.width: 640"), {"752x480", "640x480"});
  expect(Replaced("LEFT.width: 752", "LEFT.width: 752000"),
         {"left camera", "752000x480", "64000000"});
  expect(Replaced("457.587, 0.0", "0.0, 0.0"), {"right camera", "Camera.fx"});
}

TEST_F(StereoSettings, ACamchainOfKalibrIsAPair) {
  const std::string lens =
      "  camera_model: pinhole\n  intrinsics: [190.0, 190.0, 256.0, 256.0]\n"
      "  resolution: [512, 512]\n  distortion_model: equidistant\n"
      "  distortion_coeffs: [0.003, 0.0007, -0.002, 0.0002]\n";
  const auto pose = [](double x) {
    return fmt::format("  T_cam_imu: [[1, 0, 0, {}], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n",
                       x);
  };
  const auto rectifier = Read("cam0:\n" + lens + pose(0.02) + "cam1:\n" + lens + pose(-0.08));
  ASSERT_NE(rectifier, nullptr);
  EXPECT_NEAR(rectifier->camera().bf / rectifier->camera().fx, 0.1, 1e-9);
  ExpectInputError([&] { Read("cam0:\n" + lens); }, {"c.yaml: cam1 is not given"});
}

// The images of a fisheye lens are never rectified.
TEST_F(StereoSettings, OneLensWithABaselineIsThatOfBothCameras) {
  const std::string pinhole =
      "Camera.fx: 200\nCamera.fy: 200\nCamera.cx: 320\nCamera.cy: 240\n"
      "Camera.bf: 20\n";
  EXPECT_EQ(Read(pinhole), nullptr);
  const auto rectifier = Read(pinhole + "Camera.type: \"KannalaBrandt8\"\n");
  ASSERT_NE(rectifier, nullptr);
  EXPECT_NEAR(rectifier->camera().bf / rectifier->camera().fx, 0.1, 1e-9);
  EXPECT_FALSE(rectifier->camera().IsDistorted());
}

}  // namespace
}  // namespace hullslam

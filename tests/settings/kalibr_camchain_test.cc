// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/kalibr_camchain.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

constexpr const char* kLens =
    "  camera_model: pinhole\n  intrinsics: [190.0, 191.0, 256.0, 255.0]\n"
    "  resolution: [512, 510]\n  distortion_model: equidistant\n"
    "  distortion_coeffs: [0.003, 0.0007, -0.002, 0.0002]\n";

// cam0 is at (0, 0, -0.5) of the IMU, cam1 0.1 m to the right of it.
constexpr const char* kImu0 =
    "  T_cam_imu: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.5], [0, 0, 0, 1]]\n";
constexpr const char* kImu1 =
    "  T_cam_imu: [[1, 0, 0, -0.1], [0, 1, 0, 0], [0, 0, 1, 0.5], [0, 0, 0, 1]]\n";
constexpr const char* kChained =
    "  T_cn_cnm1: [[1, 0, 0, -0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n";

class KalibrCamchain : public ::testing::Test {
 protected:
  YamlMap Write(const std::string& text) {
    return {folder_.Write("camchain.yaml", text), "a camchain"};
  }

  TemporaryFolder folder_;
};

TEST_F(KalibrCamchain, BothWaysToGiveThePosesAreTheSamePair) {
  const std::string left = std::string("cam0:\n") + kLens + kImu0;
  const std::string right = std::string("cam1:\n") + kLens;
  for (const char* const pose : {kImu1, kChained}) {
    const YamlMap file = Write(left + right + pose);
    EXPECT_TRUE(IsCamchain(file));
    const StereoCalibration pair = ReadCamchainPair(file);
    EXPECT_TRUE(pair.right_from_left.translation.isApprox(Eigen::Vector3d(-0.1, 0.0, 0.0), 1e-12));
    EXPECT_EQ(pair.left.fy, 191.0);
    EXPECT_EQ(pair.right.k3, -0.002);
    EXPECT_TRUE(pair.right.IsFisheye());
    EXPECT_EQ(ReadImuFromCam0(file).translation.z(), -0.5);
  }
  EXPECT_FALSE(IsCamchain(Write("Camera.fx: 1\n")));
  EXPECT_TRUE(ReadImuFromCam0(Write(std::string("cam0:\n") + kLens)).translation.isZero());
}

// The coefficients of these lenses come first in the intrinsics.
TEST_F(KalibrCamchain, DoubleSpheresAndTheExtendedUnifiedModelAreRead) {
  const auto write = [&](const std::string& model, const std::string& numbers) {
    return Write("cam0:\n  camera_model: " + model + "\n  intrinsics: [" + numbers +
                 "]\n  distortion_model: none\n  distortion_coeffs: []\n  resolution: [512, 512]\n"
                 "cam1:\n  camera_model: " +
                 model + "\n  intrinsics: [" + numbers + "]\n  resolution: [512, 512]\n" +
                 kChained);
  };
  const StereoCalibration sphere =
      ReadCamchainPair(write("ds", "-0.17, 0.59, 158.0, 159.0, 254.0, 256.0"));
  EXPECT_EQ(sphere.right.lens, LensModel::kDoubleSphere);
  EXPECT_EQ(sphere.left.xi, -0.17);
  EXPECT_EQ(sphere.left.alpha, 0.59);
  EXPECT_NEAR(sphere.left.fy, 159.0 / (1.0 - 0.17), 1e-9) << "on the axis";
  EXPECT_EQ(sphere.left.cy, 256.0);
  const StereoCalibration unified =
      ReadCamchainPair(write("eucm", "0.6, 1.1, 191.0, 192.0, 254.0, 256.0"));
  EXPECT_EQ(unified.left.lens, LensModel::kExtendedUnified);
  EXPECT_EQ(unified.left.beta, 1.1);
  ExpectInputError([&] { ReadCamchainPair(write("ds", "158.0, 159.0, 254.0, 256.0")); },
                   {"intrinsics", "4 value(s)"});
  ExpectInputError([&] { ReadCamchainPair(write("omni", "1.5, 158.0, 159.0, 254.0, 256.0")); },
                   {"camera_model is 'omni'", "'eucm'"});
}

}  // namespace
}  // namespace hullslam

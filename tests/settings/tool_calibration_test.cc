// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/tool_calibration.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "settings/calibration_file.h"
#include "settings/stereo_settings.h"
#include "settings/yaml_map.h"
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

// The form of Basalt; the right camera is 0.1 m to the right of the left one.
constexpr const char* kPair = R"({
    "value0": {
        "T_imu_cam": [
            {"px": 0.0, "py": 0.5, "pz": 0.0, "qx": 0.0, "qy": 0.0, "qz": 0.70710678, "qw": 0.70710678},
            {"px": 0.0, "py": 0.6, "pz": 0.0, "qx": 0.0, "qy": 0.0, "qz": 0.70710678, "qw": 0.70710678}
        ],
        "intrinsics": [
            {"camera_type": "ds", "intrinsics": {"fx": 158.3, "fy": 158.2, "cx": 254.9, "cy": 256.6, "xi": -0.172, "alpha": 0.593}},
            {"camera_type": "eucm", "intrinsics": {"fx": 191.5, "fy": 191.4, "cx": 252.5, "cy": 254.7, "alpha": 0.63, "beta": 1.04}}
        ],
        "resolution": [[512, 512], [512, 512]]
    }
})";

class BasaltCalibration : public ::testing::Test {
 protected:
  std::string With(const std::string& from, const std::string& to) const {
    std::string text = kPair;
    return text.replace(text.find(from), from.size(), to);
  }
  PinholeCamera Read(const std::string& text) {
    const auto file = folder_.Write("calibration.json", text);
    const auto read = RecogniseCalibration(file, ReadYaml(file));
    return read ? read->calibration.camera : PinholeCamera();
  }

  TemporaryFolder folder_;
};

TEST_F(BasaltCalibration, ItsFirstCameraIsRead) {
  const PinholeCamera camera = Read(kPair);
  EXPECT_EQ(camera.lens, LensModel::kDoubleSphere);
  EXPECT_NEAR(camera.fx, 158.3 / (1.0 - 0.172), 1e-9) << "on the axis";
  EXPECT_EQ(camera.cy, 256.6);
  EXPECT_EQ(camera.xi, -0.172);
  EXPECT_EQ(camera.alpha, 0.593);
  EXPECT_EQ(camera.width, 512);
  EXPECT_EQ(camera.FindFault(), "");
}

TEST_F(BasaltCalibration, ItsOtherLensesAreRead) {
  const std::string ds =
      R"("ds", "intrinsics": {"fx": 158.3, "fy": 158.2, "cx": 254.9, "cy": 256.6, "xi": -0.172, "alpha": 0.593})";
  const std::string focal = R"("fx": 200, "fy": 200, "cx": 256, "cy": 256)";
  const PinholeCamera ucm =
      Read(With(ds, R"("ucm", "intrinsics": {)" + focal + R"(, "alpha": 0.6})"));
  EXPECT_EQ(ucm.lens, LensModel::kExtendedUnified);
  EXPECT_EQ(ucm.alpha, 0.6);
  EXPECT_EQ(ucm.beta, 1.0);
  const PinholeCamera kb4 = Read(With(ds, R"("kb4", "intrinsics": {)" + focal +
                                              R"(, "k1": 0.1, "k2": 0.2, "k3": 0.3, "k4": 0.4})"));
  EXPECT_EQ(kb4.lens, LensModel::kKannalaBrandt);
  EXPECT_EQ(kb4.k4, 0.4);
  const PinholeCamera pinhole = Read(With(ds, R"("pinhole", "intrinsics": {)" + focal + "}"));
  EXPECT_FALSE(pinhole.IsDistorted());
}

TEST_F(BasaltCalibration, ItsFirstTwoCamerasAreAPair) {
  const auto file = folder_.Write("calibration.json", kPair);
  EXPECT_TRUE(HasRightCamera(file));
  const std::optional<StereoCalibration> pair = ReadStereoPair(file, PinholeCamera());
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->left.lens, LensModel::kDoubleSphere);
  EXPECT_EQ(pair->right.beta, 1.04);
  EXPECT_TRUE(pair->right_from_left.translation.isApprox(Eigen::Vector3d(-0.1, 0.0, 0.0), 1e-6));
}

TEST_F(BasaltCalibration, BrokenFilesAreRefusedWithLineAndKey) {
  const auto expect = [&](const std::string& text, const std::vector<std::string>& parts) {
    ExpectInputError([&] { Read(text); }, parts);
  };
  expect(With(R"("ds")", R"("fov")"), {"calibration.json:8: camera_type is 'fov'", "eucm"});
  expect(With("-0.172", "true"), {"calibration.json:8", "xi"});
  expect(With("intrinsics\": [", "extrinsics\": ["), {"value0.intrinsics has no camera 0"});
  expect(With("[512, 512]", "[512]"), {"resolution is no list of width and height"});
  const auto file = folder_.Write("pair.json", With("0.70710678},", "1.2},"));
  ExpectInputError([&] { ReadStereoPair(file, PinholeCamera()); }, {"pair.json:4", "no rotation"});
}

}  // namespace

}  // namespace hullslam

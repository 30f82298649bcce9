// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/camera_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "hullslam/settings/settings.h"
#include "hullslam/util/error.h"
#include "settings/calibration_file.h"
#include "settings/stereo_settings.h"
#include "support/expect_error.h"
#include "support/fisheye_camera.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

PinholeCamera BrownCamera() {
  PinholeCamera camera;
  camera.fx = 517.3;
  camera.fy = 516.5;
  camera.cx = 318.6;
  camera.cy = 255.3;
  camera.k1 = 0.1;
  camera.k2 = -0.2;
  camera.p1 = -0.005;
  camera.p2 = 0.002;
  return camera;
}

// The camera that a program reads from a file of this format.
PinholeCamera ReadBack(CameraFormat format, const PinholeCamera& camera) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "camera.yaml";
  std::ofstream(file) << CameraFileText(format, camera, 30.0, {},
                                        std::vector<std::string>{"from a test"});
  PinholeCamera read = ReadSettings(file).camera;
  read.bf = camera.bf;  // only settings have it
  return read;
}

void ExpectNear(const PinholeCamera& a, const PinholeCamera& b) {
  EXPECT_EQ(a.lens, b.lens);
  EXPECT_EQ(a.width, b.width);
  for (double PinholeCamera::*field :
       {&PinholeCamera::fx, &PinholeCamera::fy, &PinholeCamera::cx, &PinholeCamera::cy,
        &PinholeCamera::k1, &PinholeCamera::k2, &PinholeCamera::k3, &PinholeCamera::k4,
        &PinholeCamera::p1, &PinholeCamera::p2, &PinholeCamera::xi, &PinholeCamera::alpha}) {
    EXPECT_NEAR(a.*field, b.*field, 1e-9);
  }
}

TEST(RightCameraSettings, ThePairIsReadBackWithEveryLens) {
  for (const PinholeCamera& camera :
       {BrownCamera(), FisheyeCamera(), DoubleSphereCamera(), ExtendedUnifiedCamera()}) {
    StereoCalibration pair{camera, camera, {ExpSo3({0.01, -0.02, 0.03}), {-0.12, 0.001, 0.002}}};
    pair.right.fx *= 1.01;
    pair.right.cy += 4.0;
    pair.right.k1 *= 0.9;
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "camera.yaml";
    std::ofstream(file) << CameraFileText(CameraFormat::kSettings, pair.left, 30.0,
                                          RightCameraSettings(pair), {});
    const auto read = ReadStereoPair(file, ReadSettings(file).camera);
    ASSERT_TRUE(read.has_value());
    ExpectNear(read->left, pair.left);
    ExpectNear(read->right, pair.right);
    const Rigid3& pose = read->right_from_left;
    EXPECT_LT(AngularDistance(pose.rotation, pair.right_from_left.rotation), 1e-9);
    EXPECT_LT((pose.translation - pair.right_from_left.translation).norm(), 1e-9);
  }
}

TEST(RightCameraSettings, DifferentLensesAreRefused) {
  ExpectInputError(
      [] {
        RightCameraSettings({BrownCamera(), FisheyeCamera(), {}});
      },
      {"expected the same model"});
}

TEST(CameraFileText, SettingsAreReadBackWithEveryLens) {
  for (const PinholeCamera& camera :
       {BrownCamera(), FisheyeCamera(), DoubleSphereCamera(), ExtendedUnifiedCamera()}) {
    ExpectNear(ReadBack(CameraFormat::kSettings, camera), camera);
  }
}

TEST(CameraFileText, KalibrsFileIsReadBack) {
  for (const PinholeCamera& camera :
       {BrownCamera(), FisheyeCamera(), DoubleSphereCamera(), ExtendedUnifiedCamera()}) {
    ExpectNear(ReadBack(CameraFormat::kKalibr, camera), camera);
  }
  PinholeCamera third = BrownCamera();
  third.k3 = 0.1;
  EXPECT_THROW(CameraFileText(CameraFormat::kKalibr, third, 30.0, {}, {}), InputError);
}

TEST(CameraFileText, CameraInfoIsReadBack) {
  PinholeCamera rational = BrownCamera();
  rational.k3 = 0.01;
  rational.k4 = 0.02;
  for (const PinholeCamera& camera : {BrownCamera(), FisheyeCamera(), rational}) {
    ExpectNear(ReadBack(CameraFormat::kRos, camera), camera);
  }
}

// COLMAP counts pixels from the corner of the first one.
TEST(CameraFileText, ColmapsPrincipalPointIsHalfAPixelFarther) {
  EXPECT_EQ(CameraFileText(CameraFormat::kColmap, BrownCamera(), 30.0, {}, {}),
            "1 OPENCV 640 480 517.3 516.5 319.1 255.8 0.1 -0.2 -0.005 0.002\n");
  PinholeCamera sphere = DoubleSphereCamera();
  EXPECT_THROW(CameraFileText(CameraFormat::kColmap, sphere, 30.0, {}, {}), InputError);
}

TEST(CameraFileText, CommentsAndExtraSettingsAreWritten) {
  const std::vector<NamedSetting> extra = {{"Camera.readout_time", "0.02"}};
  const std::vector<std::string> comments = {"sigma 1 px"};
  const std::string text =
      CameraFileText(CameraFormat::kSettings, BrownCamera(), 30.0, extra, comments);
  EXPECT_TRUE(text.starts_with("%YAML:1.0\n# sigma 1 px\n"));
  EXPECT_NE(text.find("\nCamera.readout_time: 0.02\n"), std::string::npos);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/basalt_calibration.h"

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/settings_orb_slam3.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hullslam/settings/settings.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// A file with the keys of ORB-SLAM3's format 1.0 for an RGB-D camera with an IMU.
constexpr const char* kOrbSlam3 = R"(%YAML:1.0
File.version: "1.0"
Camera.type: "PinHole"

Camera1.fx: 517.306408
Camera1.fy: 516.469215
Camera1.cx: 318.643040
Camera1.cy: 255.313989
Camera1.k1: 0.262383
Camera1.k2: -0.953104
Camera1.p1: -0.005358
Camera1.p2: 0.002628
Camera1.k3: 1.163314

Camera.width: 1280
Camera.height: 720
Camera.newWidth: 1280
Camera.newHeight: 720
Camera.fps: 15
Camera.RGB: 0

Stereo.ThDepth: 35.0
Stereo.b: 0.05
RGBD.DepthMapFactor: 1000.0

IMU.NoiseGyro: 1e-3
IMU.T_b_c1: !!opencv-matrix
   rows: 2
   cols: 2
   dt: f
   data: [1.0, 0.0,
          0.0, 1.0]

ORBextractor.nFeatures: 1250
loopClosing: 0
Viewer.ViewpointX: 0.0
Viewer.imageViewScale: 1.0
)";

class SettingsOrbSlam3 : public ::testing::Test {
 protected:
  // The file in which the line that starts with `begin` is replaced. If no line does, `line` is
  // added at the end.
  static std::string With(const std::string& begin, const std::string& line) {
    std::string text = kOrbSlam3;
    const size_t at = text.find('\n' + begin);
    if (begin.empty() || at == std::string::npos) {
      return text + line + '\n';
    }
    return text.replace(at + 1, text.find('\n', at + 1) - at - 1, line);
  }
  SystemOptions Read(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return ReadSettings(folder_.Write("camera.yaml", text), overrides);
  }
  void ExpectError(const std::string& begin, const std::string& line,
                   const std::vector<std::string>& parts) {
    SCOPED_TRACE(line);
    ExpectInputError([&] { Read(With(begin, line)); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(SettingsOrbSlam3, AreTranslated) {
  const SystemOptions options = Read(kOrbSlam3);
  EXPECT_EQ(options.camera.fx, 517.306408);
  EXPECT_EQ(options.camera.fy, 516.469215);
  EXPECT_EQ(options.camera.cx, 318.643040);
  EXPECT_EQ(options.camera.cy, 255.313989);
  EXPECT_EQ(options.camera.k1, 0.262383);
  EXPECT_EQ(options.camera.k2, -0.953104);
  EXPECT_EQ(options.camera.p1, -0.005358);
  EXPECT_EQ(options.camera.p2, 0.002628);
  EXPECT_EQ(options.camera.k3, 1.163314);
  EXPECT_EQ(options.camera.width, 1280);
  EXPECT_EQ(options.camera.height, 720);
  EXPECT_DOUBLE_EQ(options.camera.bf, 0.05 * 517.306408);
  EXPECT_EQ(options.frames_per_second, 15.0);
  EXPECT_FALSE(options.rgb_order);
  EXPECT_EQ(options.depth.close_baselines, 35.0);
  EXPECT_EQ(options.depth.units_per_metre, 1000.0);
  EXPECT_EQ(options.features.feature_count, 1250);
  EXPECT_FALSE(options.loop.enabled);
}

TEST_F(SettingsOrbSlam3, OurOwnKeysAndOverridesWorkToo) {
  const SystemOptions options =
      Read(With("", "objects.detection.min_score: 0.5"), {"Camera.bf=40", "Camera.fx=500"});
  EXPECT_EQ(options.objects.detection.min_score, 0.5);
  EXPECT_EQ(options.camera.bf, 40.0);
  EXPECT_EQ(options.camera.fx, 500.0);
}

TEST_F(SettingsOrbSlam3, TheBaselineMayComeBeforeTheFocalLength) {
  EXPECT_DOUBLE_EQ(Read("%YAML:1.0\nStereo.b: 0.1\nCamera1.fx: 400.0\nCamera1.fy: 400.0\n"
                        "Camera1.cx: 320.0\nCamera1.cy: 240.0\n")
                       .camera.bf,
                   40.0);
}

// The keys of ORB-SLAM3's TUM-VI.yaml, with shortened numbers.
TEST_F(SettingsOrbSlam3, AFisheyeIsRead) {
  const PinholeCamera camera =
      Read(
          "%YAML:1.0\nFile.version: \"1.0\"\nCamera.type: \"KannalaBrandt8\"\n"
          "Camera1.fx: 190.978\nCamera1.fy: 190.973\nCamera1.cx: 254.932\nCamera1.cy: 256.897\n"
          "Camera1.k1: 0.00348\nCamera1.k2: 0.000715\nCamera1.k3: -0.00205\n"
          "Camera1.k4: 0.000203\nCamera1.overlappingBegin: 0\nCamera1.overlappingEnd: 511\n"
          "Camera.width: 512\nCamera.height: 512\nCamera.newWidth: 512\nCamera.newHeight: 512\n")
          .camera;
  EXPECT_TRUE(camera.IsFisheye());
  EXPECT_EQ(camera.k4, 0.000203);
  EXPECT_EQ(camera.cx, 254.932) << "the images keep their size";
}

TEST_F(SettingsOrbSlam3, RectifiedImagesHaveNoDistortion) {
  ExpectError("Camera.type", "Camera.type: \"Rectified\"",
              {"camera.yaml:9: Camera1.k1 is '0.262383'", "Rectified"});
  EXPECT_FALSE(Read("%YAML:1.0\nFile.version: \"1.0\"\nCamera.type: \"Rectified\"\n"
                    "Camera1.fx: 400.0\nCamera1.fy: 400.0\nCamera1.cx: 320.0\nCamera1.cy: 240.0\n")
                   .camera.IsDistorted());
}

TEST_F(SettingsOrbSlam3, SettingsThatCannotBeTranslatedAreNamed) {
  ExpectError("Camera.type", "Camera.type: \"Omni\"",
              {"camera.yaml:3: Camera.type is 'Omni'", "\"PinHole\" or \"Rectified\"",
               "no other camera model"});
  ExpectError("File.version", "File.version: \"2.0\"",
              {"camera.yaml:2: File.version is '2.0'", "\"1.0\""});
  ExpectError("", "System.thFarPoints: 20.0", {"System.thFarPoints", "far points"});
  ExpectError("", "System.LoadAtlasFromFile: \"a\"", {"System.LoadAtlasFromFile", "maps"});
  ExpectError("Camera.newWidth", "Camera.newWidth: 8",
              {"camera.yaml:17: Camera.newWidth is '8'", "from 16 to 16384"});
}

TEST_F(SettingsOrbSlam3, BadValuesAreReportedByTheNameInTheFile) {
  ExpectError("Camera1.fx", "Camera1.fx: -5",
              {"camera.yaml:5: Camera1.fx: Camera.fx is '-5'", "from 10"});
  ExpectError("Camera1.fx", "Camera1.fx: \"5\"", {"Camera1.fx: Camera.fx is '\"5\"'"});
  ExpectError("Stereo.b", "Stereo.b: 0", {"Stereo.b is '0'", "> 0"});
  ExpectError("Stereo.b", "Stereo.b: [1, 2]", {"Stereo.b is a list"});
  ExpectError("Camera1.fx", "Camera1.fz: 500.0", {"unknown key 'Camera1.fz'"});
  ExpectError("", "Camera.fx: 500.0", {"Camera.fx was given before under another name"});
  ExpectError("", "Camera.bf: 40.0", {"Stereo.b was given before under another name"});
  ExpectError("Camera1.fx", "", {"Camera.fx is not given"});
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/settings/settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "support/expect_error.h"
#include "support/paths.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// A file with the layout of the files of ORB-SLAM2: sections, comments and keys of its viewer.
constexpr const char* kOrbSlam2 = R"(%YAML:1.0

#--------------------------------------------------------------------------------------------
# Camera Parameters. Adjust them!
#--------------------------------------------------------------------------------------------

# Camera calibration and distortion parameters (OpenCV)
Camera.fx: 517.306408
Camera.fy: 516.469215
Camera.cx: 318.643040
Camera.cy: 255.313989

Camera.k1: 0.262383
Camera.k2: -0.953104
Camera.p1: -0.005358
Camera.p2: 0.002628
Camera.k3: 1.163314

Camera.width: 640
Camera.height: 480

# Camera frames per second
Camera.fps: 30.0
Camera.bf: 40.0
Camera.RGB: 1
ThDepth: 40.0
DepthMapFactor: 5000.0

ORBextractor.nFeatures: 1000
ORBextractor.scaleFactor: 1.2
ORBextractor.nLevels: 8
ORBextractor.iniThFAST: 20
ORBextractor.minThFAST: 7

Viewer.KeyFrameSize: 0.05
Viewer.KeyFrameLineWidth: 1
Viewer.GraphLineWidth: 0.9
Viewer.PointSize:2
Viewer.CameraSize: 0.08
Viewer.CameraLineWidth: 3
Viewer.ViewpointX: 0
Viewer.ViewpointY: -0.7
Viewer.ViewpointZ: -1.8
Viewer.ViewpointF: 500
)";

constexpr const char* kMinimal =
    "%YAML:1.0\nCamera.fx: 500.\nCamera.fy: 500.0\nCamera.cx: 320\nCamera.cy: 240\n";

class Settings : public ::testing::Test {
 protected:
  SystemOptions Read(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return ReadSettings(folder_.Write("camera.yaml", text), overrides);
  }
  void ExpectError(const std::string& text, const std::vector<std::string>& parts,
                   const std::vector<std::string>& overrides = {}) {
    ExpectInputError([&] { Read(text, overrides); }, parts);
  }
  void ExpectLineError(const std::string& line, std::vector<std::string> parts) {
    parts.emplace_back("camera.yaml:6: ");
    ExpectError(kMinimal + line + "\n", parts);
  }

  TemporaryFolder folder_;
};

TEST_F(Settings, FilesOfOrbSlam2WorkUnchanged) {
  const SystemOptions options = Read(kOrbSlam2);
  EXPECT_EQ(options.camera.fx, 517.306408);
  EXPECT_EQ(options.camera.fy, 516.469215);
  EXPECT_EQ(options.camera.cx, 318.643040);
  EXPECT_EQ(options.camera.cy, 255.313989);
  EXPECT_EQ(options.camera.k2, -0.953104);
  EXPECT_EQ(options.camera.k3, 1.163314);
  EXPECT_EQ(options.camera.width, 640);
  EXPECT_EQ(options.camera.bf, 40.0);
  EXPECT_TRUE(options.rgb_order);
  EXPECT_EQ(options.frames_per_second, 30.0);
  EXPECT_EQ(options.depth.units_per_metre, 5000.0);
  EXPECT_EQ(options.features.feature_count, 1000);
  EXPECT_EQ(options.features.scale_factor, 1.2);
}

TEST_F(Settings, CarriageReturnsAndAByteOrderMarkAreAccepted) {
  std::string text = "\xEF\xBB\xBF" + std::string(kMinimal);
  for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) {
    text.replace(at, 1, "\r\n");
  }
  EXPECT_EQ(Read(text).camera.fx, 500.0);
}

TEST_F(Settings, TheFirstLineMayBeMissingOrComeLater) {
  const std::string lines = std::string(kMinimal).substr(10);
  for (const std::string head :
       {"", "# my camera\n%YAML:1.0\n", "\n\n%YAML:1.0\n---\n", "# mine\n", "\r\n%YAML:1.0\r\n"}) {
    EXPECT_EQ(Read(head + lines).camera.fx, 500.0) << head;
    const auto line = 5 + std::count(head.begin(), head.end(), '\n');
    ExpectError(head + lines + "Camera.gx: 1\n",
                {"camera.yaml:" + std::to_string(line) + ": unknown key 'Camera.gx'"});
  }
  ExpectError("a: 1\n", {"camera.yaml:1: unknown key 'a'"});
}

TEST_F(Settings, WholeNumbersMayBeWrittenWithAPoint) {
  EXPECT_EQ(Read(std::string(kMinimal) + "ORBextractor.nFeatures: 1500.\n").features.feature_count,
            1500);
  ExpectLineError("ORBextractor.nFeatures: 1000.5",
                  {"ORBextractor.nFeatures is '1000.5'", "an integer"});
}

TEST_F(Settings, FeaturesFollowTheSizeOfTheImageUnlessTheyAreSet) {
  const std::string small = std::string(kMinimal) + "Camera.width: 416\nCamera.height: 128\n";
  EXPECT_EQ(Read(kMinimal).features.level_count, 8);
  EXPECT_EQ(Read(kMinimal).features.feature_count, 1000);
  const FeatureOptions followed = Read(small).features;
  EXPECT_EQ(followed.level_count, 4);
  EXPECT_EQ(followed.feature_count, followed.FeaturesFor(416, 128));
  const std::vector<std::string> set = {"ORBextractor.nLevels=3", "ORBextractor.nFeatures=500"};
  EXPECT_EQ(Read(small, set).features.level_count, 3);
  EXPECT_EQ(Read(small, set).features.feature_count, 500);
  const CameraCalibration calibration{.camera = Read(small).camera};
  EXPECT_EQ(MakeSettings(calibration, "test").features.level_count, 4);
}

TEST_F(Settings, AFileReplacesThePresetAndOverridesReplaceBoth) {
  const Preset preset{.name = "made",
                      .file = "made.yaml",
                      .settings = {{"objects.sigma", "3", "made.yaml:2"},
                                   {"loop.min_matches", "25", "made.yaml:3"},
                                   {"loop.min_landmarks", "50", "made.yaml:4"},
                                   {"ORBextractor.nFeatures", "900", "made.yaml:5"}}};
  const auto file = folder_.Write(
      "camera.yaml", std::string(kMinimal) + "objects.pose.sigma: 4\nloop.min_matches: 26\n");
  const std::vector<std::string> overrides = {"loop.min_matches=27"};
  SettingsNotes report;
  const SystemOptions options =
      ReadSettings(file, {.preset = &preset, .overrides = overrides}, report);
  EXPECT_EQ(options.objects.pose.constraint.sigma_px, 4.0);
  EXPECT_EQ(options.objects.bundle.constraint.sigma_px, 3.0);
  EXPECT_EQ(options.loop.min_matches, 27);
  EXPECT_EQ(options.loop.min_landmarks, 50);
  EXPECT_EQ(options.features.feature_count, 900);
  ASSERT_EQ(report.preset_overrides.size(), 2u);
  EXPECT_EQ(report.preset_overrides[0].key, "loop.min_matches");
  EXPECT_EQ(report.preset_overrides[0].origin, "--set");
  EXPECT_EQ(report.preset_overrides[1].key, "objects.pose.sigma");
  EXPECT_TRUE(report.preset_overrides[1].origin.ends_with("camera.yaml:6"));
  ASSERT_EQ(report.warnings.size(), 1u);  // what --set replaces needs no warning
  EXPECT_NE(report.warnings[0].find("objects.pose.sigma is 4"), std::string::npos);
  EXPECT_NE(report.warnings[0].find("preset made has 3"), std::string::npos);
}

TEST_F(Settings, ACalibrationReplacesThePresetToo) {
  const Preset preset{
      .name = "made",
      .file = "made.yaml",
      .settings = {{"Camera.fps", "10", "made.yaml:2"}, {"loop.min_matches", "25", "made.yaml:3"}}};
  SettingsNotes report;
  const CameraCalibration calibration{.camera = Read(kMinimal).camera, .frames_per_second = 20.0};
  const SystemOptions options =
      MakeSettings(calibration, "sensor.yaml", {.preset = &preset}, report);
  EXPECT_EQ(options.frames_per_second, 20.0);
  EXPECT_EQ(options.loop.min_matches, 25);
  ASSERT_EQ(report.preset_overrides.size(), 1u);
  EXPECT_EQ(report.preset_overrides[0].origin, "sensor.yaml");
}

TEST_F(Settings, WithoutCorrectionOfTheShutterTheReadoutTimeIsZero) {
  const std::string rolling = std::string(kMinimal) + "Camera.readout_time: 0.026\n";
  EXPECT_EQ(Read(rolling).readout_time, 0.026);
  EXPECT_EQ(Read(rolling, {"tracking.correct_shutter=false"}).readout_time, 0.0);
  const auto file = folder_.Write("camera.yaml", rolling);
  const std::vector<std::string> overrides = {"tracking.correct_shutter=false",
                                              "Camera.readout_time=0.02"};
  std::vector<std::string> warnings;
  EXPECT_EQ(ReadSettings(file, overrides, NegativeFy::kError, &warnings).readout_time, 0.0);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("Camera.readout_time has no effect"), std::string::npos);
}

TEST_F(Settings, MessagesNameTheSourceOfOverrides) {
  const auto file = folder_.Write("camera.yaml", kMinimal);
  const auto expect = [&](const std::string& assignment, const std::string& message) {
    const std::vector<std::string> overrides = {assignment};
    SettingsNotes report;
    ExpectInputError(
        [&] {
          ReadSettings(file, {.overrides = overrides, .overrides_origin = "Settings"}, report);
        },
        {message});
  };
  expect("Camera.fx=a", "Settings: Camera.fx is 'a'");
  expect("Camera.fx", "Settings: 'Camera.fx', expected key=value");
  expect("Camera.gx=1", "Settings: unknown key 'Camera.gx'");
}

TEST_F(Settings, LevelsThatHaveNoRoomAreLeftOutWithAWarning) {
  const auto file = folder_.Write(
      "camera.yaml",
      std::string(kMinimal) + "Camera.width: 416\nCamera.height: 128\nORBextractor.nLevels: 8\n");
  std::vector<std::string> warnings;
  EXPECT_EQ(ReadSettings(file, {}, NegativeFy::kError, &warnings).features.level_count, 4);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("nLevels is 8"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("416x128"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("4 are used"), std::string::npos) << warnings[0];
}

TEST_F(Settings, OverridesReplaceValuesOfTheFile) {
  EXPECT_EQ(Read(kMinimal, {"ORBextractor.nFeatures=700", "Camera.fx = 400"}).camera.fx, 400.0);
  ExpectError(kMinimal, {"--set", "ORBextractor.nFeatures is '-1'", "expected an integer"},
              {"ORBextractor.nFeatures=-1"});
  ExpectError(kMinimal, {"--set", "unknown key 'ORBextractor.nFeature'", "ORBextractor.nFeatures"},
              {"ORBextractor.nFeature=5"});
  ExpectError(kMinimal, {"--set", "'Camera.fx'", "key=value"}, {"Camera.fx"});
}

TEST_F(Settings, EachProgramDecidesWhetherFyMayBeNegative) {
  const std::string text =
      "%YAML:1.0\nCamera.fx: 481.2\nCamera.fy: -480.0\nCamera.cx: 319.5\nCamera.cy: 239.5\n";
  ExpectError(text, {"camera.yaml:3: Camera.fy is '-480", "mirrored world", "rgbd_icl"});
  const auto file = folder_.Write("camera.yaml", text);
  EXPECT_EQ(ReadSettings(file, {}, NegativeFy::kPositive).camera.fy, 480.0);
  const std::vector<std::string> overrides = {"Camera.fy=-480"};
  ExpectInputError([&] { ReadSettings(file, overrides, NegativeFy::kPositive); },
                   {"--set", "Camera.fy is '-480'"});
}

TEST_F(Settings, TheConfigurationOfIclNuimIsRightHanded) {
  const SystemOptions options = ReadSettings(FindConfigFolder() / "ICL.yaml");
  EXPECT_EQ(options.camera.fx, 481.2);
  EXPECT_EQ(options.camera.fy, 480.0);
  EXPECT_EQ(options.camera.cx, 319.5);
  EXPECT_EQ(options.camera.cy, 239.5);
  EXPECT_FALSE(options.camera.IsDistorted());
  EXPECT_EQ(options.depth.units_per_metre, 5000.0);
}

// config/EuRoC.yaml must give the same run as the calibration file in every sequence of EuRoC.
TEST_F(Settings, TheConfigurationOfEurocIsThatOfItsSensorFile) {
  const auto sensor = folder_.Write(
      "sensor.yaml",
      "T_BS:\n  cols: 4\n  rows: 4\n"
      "  data: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0,\n"
      "         0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]\n"
      "rate_hz: 20\nresolution: [752, 480]\ncamera_model: pinhole\n"
      "intrinsics: [458.654, 457.296, 367.215, 248.375]\n"
      "distortion_model: radial-tangential\n"
      "distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n");
  const SystemOptions options = ReadSettings(SourceFolder() / "config" / "EuRoC.yaml");
  EXPECT_EQ(FormatSettings(options),
            FormatSettings(MakeSettings(ReadEurocCamera(sensor).calibration, sensor.string())));
}

// When a key is renamed, the files of config/ must be changed too.
TEST_F(Settings, EveryFileOfTheConfigurationIsRead) {
  size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SourceFolder() / "config")) {
    if (entry.path().extension() == ".yaml") {
      ++files;
      EXPECT_NO_THROW(ReadSettings(entry.path())) << entry.path();
    }
  }
  EXPECT_GE(files, 5U);
}

TEST_F(Settings, ACalibrationReplacesASettingsFile) {
  CameraCalibration calibration;
  calibration.camera = {.fx = 458.654,
                        .fy = 457.1,
                        .cx = 367.2,
                        .cy = 248.375,
                        .k1 = -0.28,
                        .k2 = 0.074,
                        .width = 752};
  calibration.frames_per_second = 20.0;
  const std::vector<std::string> overrides = {"ORBextractor.nFeatures=1500", "Camera.cx=300"};
  const SystemOptions options = MakeSettings(calibration, "sensor.yaml", overrides);
  calibration.camera.cx = 300.0;
  EXPECT_TRUE(options.camera == calibration.camera);
  EXPECT_EQ(options.frames_per_second, 20.0);
  EXPECT_EQ(options.features.feature_count, 1500);
  calibration.camera.width = 8;
  ExpectInputError([&] { MakeSettings(calibration, "sensor.yaml"); },
                   {"sensor.yaml: Camera.width is '8'"});
}

TEST_F(Settings, OverridesCanGiveMissingIntrinsics) {
  const std::string text = "%YAML:1.0\nCamera.fx: 50\nCamera.fy: 50\nCamera.cx: 5\n";
  EXPECT_EQ(Read(text, {"Camera.cy=7"}).camera.cy, 7.0);
  ExpectError(text, {"camera.yaml", "Camera.cy is not given"});
}

TEST_F(Settings, BrokenValuesAreReportedWithLineKeyAndExpectation) {
  ExpectLineError("ORBextractor.nFeatures: -5", {"ORBextractor.nFeatures is '-5'", "an integer"});
  ExpectLineError("Camera.width: 99999999999", {"Camera.width is '99999999999'", "an integer"});
  ExpectLineError("DepthMapFactor: 0", {"DepthMapFactor is '0'", "from 0.001 to 1e+06"});
  ExpectLineError("DepthMapFactor: lots", {"DepthMapFactor is 'lots'", "a number"});
  ExpectLineError("DepthMapFactor: \"5000\"", {"DepthMapFactor is '\"5000\"'", "a number"});
  ExpectLineError("DepthMapFactor: .nan", {"DepthMapFactor is '.nan'"});
  ExpectLineError("DepthMapFactor: .Inf", {"DepthMapFactor is '.Inf'"});
  ExpectLineError("DepthMapFactor: [1, 2]", {"DepthMapFactor is a list", "a single value"});
  ExpectLineError("DepthMapFactor: {a: 1}", {"DepthMapFactor is a map", "a single value"});
  ExpectLineError("Camera.RGB: maybe", {"Camera.RGB is 'maybe'", "true or false"});
  ExpectLineError("Camera.fxx: 5", {"unknown key 'Camera.fxx'", "did you mean 'Camera.fx'"});
  ExpectLineError("Camera.fy: 5", {"'Camera.fy' was given before, in line 3"});
}

// Azure Kinect and OAK-D have such lenses; ORB-SLAM3's forks write zeros.
TEST_F(Settings, TheRationalModelIsRead) {
  const PinholeCamera camera =
      Read(std::string(kMinimal) + "Camera.k4: 0.1\nCamera.k5: 0.02\nCamera.k6: 0.003\n").camera;
  EXPECT_EQ(camera.k4, 0.1);
  EXPECT_EQ(camera.k5, 0.02);
  EXPECT_EQ(camera.k6, 0.003);
  ExpectLineError("Camera.k4: much", {"Camera.k4 is 'much'", "a number"});
  ExpectError(kMinimal, {"Camera.k4 is '9'", "cannot be undone", "because it folds"},
              {"Camera.k4=9"});
}

TEST_F(Settings, AFisheyeHasItsTypeAndFourCoefficients) {
  const std::string fisheye =
      std::string(kMinimal) +
      "Camera.type: \"KannalaBrandt8\"\nCamera.k1: 0.01\nCamera.k4: 0.002\n";
  EXPECT_TRUE(Read(fisheye).camera.IsFisheye());
  EXPECT_EQ(Read(fisheye).camera.k4, 0.002);
  ExpectError(fisheye, {"Camera.p1 is '0.1', expected 0", "only k1 to k4"}, {"Camera.p1=0.1"});
  ExpectError(fisheye, {"Camera.k1 is '-3'", "it folds", "px from the principal point"},
              {"Camera.k1=-3"});
  ExpectLineError("Camera.type: \"Omni\"", {"Camera.type is 'Omni'", "KannalaBrandt8"});
}

TEST_F(Settings, ACalibrationOfAnotherProgramIsReadAndNamed) {
  const auto file = folder_.Write(
      "camera.yaml",
      "cam0:\n  camera_model: pinhole\n  intrinsics: [190, 191, 254, 256]\n"
      "  distortion_model: equidistant\n  distortion_coeffs: [0.003, 0.0007, -0.002, 0.0002]\n"
      "  resolution: [512, 512]\n");
  SettingsNotes report;
  const std::vector<std::string> overrides = {"Camera.bf=20"};
  const SystemOptions options = ReadSettings(file, {.overrides = overrides}, report);
  EXPECT_EQ(options.camera.fy, 191.0);
  EXPECT_EQ(options.camera.bf, 20.0);
  EXPECT_EQ(report.camera_note,
            "a camchain of Kalibr, camera cam0 of 1: 512x512 px, with a fisheye lens "
            "(Kannala-Brandt)");
}

TEST_F(Settings, SizesOfObjectsAreAMapOrAText) {
  const std::string camera =
      "%YAML:1.0\nCamera.fx: 50\nCamera.fy: 50\nCamera.cx: 5\nCamera.cy: 5\n";
  const std::map<std::string, double> sizes = {{"cup", 0.1}, {"potted plant", 0.5}};
  EXPECT_EQ(Read(camera + "objects.sizes:\n  cup: 0.1\n  potted plant: 0.5\n").objects.sizes,
            sizes);
  EXPECT_EQ(Read(camera + "objects.sizes: {cup: 0.1, potted plant: 0.5}\n").objects.sizes, sizes);
  EXPECT_EQ(Read(camera + "objects.sizes: \"cup: 0.1, potted plant: 0.5\"\n").objects.sizes, sizes);
  EXPECT_TRUE(Read(camera + "objects.sizes: {}\n").objects.sizes.empty());
  EXPECT_EQ(Read(camera, {"objects.sizes=potted plant:0.5,cup:0.1"}).objects.sizes, sizes);
  ExpectLineError("objects.sizes: {cup: -1}", {"objects.sizes is 'cup:-1'", "name:number pairs"});
  ExpectLineError("objects.sizes: {cup: big}", {"objects.sizes is 'cup:big'", "name:number pairs"});
  ExpectLineError("objects.sizes: {cup: {x: 1}}", {"objects.sizes is a map", "a single value"});
  ExpectLineError("objects.sizes: [1, 2]", {"objects.sizes is a list", "a single value"});
  ExpectLineError("objects.sizes: 0.1", {"objects.sizes is '0.1'", "name:number pairs"});
}

TEST_F(Settings, AZeroFocalLengthIsRefused) {
  ExpectError("%YAML:1.0\nCamera.fx: 0.0\n",
              {"camera.yaml:2: ", "Camera.fx is '0'", "from 10 to 1e+05"});
}

TEST_F(Settings, ImpossibleCamerasAreRefusedWithTheirKey) {
  for (const char* const value : {"1e-300", "1e300", "1e9"}) {
    ExpectError(std::string("%YAML:1.0\nCamera.fx: ") + value + "\n",
                {"camera.yaml:2: ", "Camera.fx is ", "from 10 to 1e+05"});
  }
  ExpectError(kMinimal, {"Camera.k1 is '-5'", "cannot be undone"}, {"Camera.k1=-5"});
  ExpectError(kMinimal, {"Camera.k3 is '1e+06'", "times the width"}, {"Camera.k3=1000000"});
}

TEST_F(Settings, DeepNestingIsRefused) {
  const auto repeat = [](const std::string& text, size_t bytes) {
    std::string repeated;
    while (repeated.size() < bytes) {
      repeated += text;
    }
    return repeated;
  };
  for (const char* const opening :
       {"[", "{a: ", "- ", "a: ", "? ", "-\n", "[\r", "!!map ", "&a "}) {
    try {
      Read(std::string(kMinimal) + "Camera.k1: " + repeat(opening, 900'000));
      ADD_FAILURE() << opening;
    } catch (const InputError& error) {
      EXPECT_LT(std::string(error.what()).size(), 400U) << opening;
    }
  }
  std::string indented = kMinimal;
  for (size_t depth = 0; depth < 1300; ++depth) {
    indented += std::string(depth, ' ') + "a:\n";
  }
  ExpectError(indented, {"camera.yaml:", "nested too deep"});
}

TEST_F(Settings, LongKeysAndValuesAreCutInMessages) {
  const std::string text(900'000, 'k');
  for (const std::string& line : {text + ": 1\n", "Camera.fps: " + text + "\n"}) {
    try {
      Read(kMinimal + line);
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_LT(std::string(error.what()).size(), 400U);
      EXPECT_NE(std::string(error.what()).find("camera.yaml:6: "), std::string::npos);
    }
  }
  ExpectError(kMinimal + text + text, {"camera.yaml: 1800073 bytes", "at most 1 MB"});
}

TEST_F(Settings, FilesThatAreNotYamlAreRefused) {
  ExpectError("", {"camera.yaml", "has no settings"});
  ExpectError("Camera.fx: 500\n", {"camera.yaml", "Camera.fy is not given"});
  ExpectError(std::string("\x7f"
                          "ELF\x02\0\0",
                          7),
              {"camera.yaml", "not a text file"});
  ExpectError(std::string("%YAML:1.0\na\0b: 1\n", 17), {"camera.yaml", "not a text file"});
  ExpectError("%YAML:1.0\n", {"camera.yaml", "has no settings"});
  ExpectError("%YAML:1.0\n- 1\n- 2\n", {"camera.yaml", "has no settings"});
  ExpectError("%YAML:1.0\n---\nCamera.fx 500\nb: 2\n", {"camera.yaml:4: "});
  ExpectError("%YAML:1.0\nCamera.fx: \"500\n", {"camera.yaml:2: "});
  ExpectInputError([&] { ReadSettings(folder_.path() / "none.yaml"); }, {"none.yaml", "No such"});
  ExpectInputError([&] { ReadSettings(folder_.path()); }, {"is a folder"});
}

TEST_F(Settings, RandomBytesGiveAnInputError) {
  uint32_t state = 1;
  for (int i = 0; i < 300; ++i) {
    std::string text = kOrbSlam2;
    for (int k = 0; k < 4; ++k) {
      state = state * 1664525 + 1013904223;
      text[10 + (state >> 8) % (text.size() - 10)] = static_cast<char>(state >> 24);
    }
    try {
      Read(text);
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()), "");
    }
  }
}

TEST_F(Settings, WrittenSettingsAreReadBackUnchanged) {
  const SystemOptions options =
      Read(kOrbSlam2, {"ORBextractor.nFeatures=1234", "objects.sizes=cup:0.1,potted plant:2"});
  const std::string text = FormatSettings(options);
  EXPECT_NE(text.find("\nORBextractor.nFeatures: 1234\n"), std::string::npos);
  EXPECT_NE(text.find("\nobjects.sizes: \"cup:0.1,potted plant:2\"\n"), std::string::npos);
  EXPECT_EQ(FormatSettings(Read(text)), text);
}

TEST_F(Settings, DifferentSettingsHaveDifferentHashes) {
  const std::string hash = HashSettings(Read(kOrbSlam2));
  EXPECT_EQ(hash.size(), 16U);
  EXPECT_EQ(HashSettings(Read(FormatSettings(Read(kOrbSlam2)))), hash);
  EXPECT_NE(HashSettings(Read(kOrbSlam2, {"Camera.fx=517.306409"})), hash);
}

TEST_F(Settings, TheDefaultFileDependsOnTheNameOfTheSequence) {
  const auto expect = [](const char* sequence, const char* file) {
    EXPECT_EQ(FindDefaultSettings(sequence, "/config"), std::filesystem::path("/config") / file);
  };
  expect("/data/rgbd_dataset_freiburg1_xyz", "TUM1.yaml");
  expect("/data/rgbd_dataset_freiburg2_desk/", "TUM2.yaml");
  expect("fr3_long_office_household", "TUM3.yaml");
  expect("Freiburg3", "TUM3.yaml");
  for (const char* name : {"/data/my_room", "/fr1/other", "fr10_x", "afr1", "fr4", "fr"}) {
    ExpectInputError([&] { FindDefaultSettings(name, "/config"); }, {name, "--settings"});
  }
}

TEST_F(Settings, AFileInTheSequenceTakesPrecedence) {
  const auto own = folder_.Write("fr1_like/camera.yaml", kMinimal);
  EXPECT_EQ(FindDefaultSettings(own.parent_path(), "/config"), own);
}

TEST_F(Settings, TheSettingsOfKnownCamerasAreFoundAndRead) {
  // NOLINTBEGIN(concurrency-mt-unsafe): this test has one thread
  ::setenv("HULLSLAM_CONFIG", (SourceFolder() / "config").c_str(), 1);
  const std::filesystem::path folder = FindConfigFolder();
  EXPECT_EQ(folder, SourceFolder() / "config");
  for (const char* const name : {"fr1_xyz", "fr2_desk", "fr3_office"}) {
    EXPECT_GT(ReadSettings(FindDefaultSettings(name, folder)).camera.fx, 500.0);
  }
  ::setenv("HULLSLAM_CONFIG", "/no/such/folder", 1);
  ExpectInputError([] { FindConfigFolder(); }, {"HULLSLAM_CONFIG", "/no/such/folder"});
  ::setenv("HULLSLAM_CONFIG", "", 1);
  EXPECT_NO_THROW(FindConfigFolder()) << "an empty variable counts as not set";
  ::unsetenv("HULLSLAM_CONFIG");
  // NOLINTEND(concurrency-mt-unsafe)
  EXPECT_TRUE(std::filesystem::exists(FindConfigFolder() / "TUM1.yaml"));
}

// The rows that the table of docs/settings.md must have.
std::string SettingsTable() {
  std::string table = "| key | default | allowed | meaning |\n|---|---|---|---|\n";
  SystemOptions options;
  for (const OptionTable::Entry& entry : options.Bind().Entries()) {
    const bool is_required = entry.key.ends_with(".fx") || entry.key.ends_with(".fy") ||
                             entry.key.ends_with(".cx") || entry.key.ends_with(".cy");
    table += "| `" + entry.key + "` | " + (is_required ? "required" : entry.value) + " | " +
             entry.expected + " | " + entry.help + " |\n";
  }
  return table;
}

// With HULLSLAM_UPDATE_DOCS=1 the table is written into the file.
TEST_F(Settings, TheTableOfTheDocsIsThatOfTheOptions) {
  const std::filesystem::path file = SourceFolder() / "docs/settings.md";
  const std::string docs = ReadFile(file);
  const std::string begin_mark = "<!-- begin of the table of settings -->\n";
  const std::string end_mark = "<!-- end of the table of settings -->";
  const size_t begin = docs.find(begin_mark);
  const size_t end = docs.find(end_mark);
  ASSERT_NE(begin, std::string::npos);
  ASSERT_NE(end, std::string::npos);
  const size_t first = begin + begin_mark.size();
  const std::string expected =
      docs.substr(0, first) + "\n" + SettingsTable() + "\n" + docs.substr(end);
  // NOLINTNEXTLINE(concurrency-mt-unsafe): this test has one thread
  if (std::getenv("HULLSLAM_UPDATE_DOCS") != nullptr) {
    std::ofstream(file) << expected;
    return;
  }
  EXPECT_TRUE(docs == expected)
      << "the table of docs/settings.md differs from the options; to write it, run\n"
         "HULLSLAM_UPDATE_DOCS=1 ctest --preset release -R TheTableOfTheDocs";
}

}  // namespace
}  // namespace hullslam

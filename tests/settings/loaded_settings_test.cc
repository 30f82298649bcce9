// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/settings/loaded_settings.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

constexpr const char* kCameraOfFile =
    "Camera.fx: 500\nCamera.fy: 500\nCamera.cx: 320\nCamera.cy: 240\n";

TEST(LoadSettings, OverridesWinOverTheFileAndThePreset) {
  const TemporaryFolder folder;
  const auto preset = folder.Write("mine.yaml", "objects.pose.sigma: 3\nloop.min_matches: 41\n");
  const auto file =
      folder.Write("camera.yaml", std::string(kCameraOfFile) + "objects.pose.sigma: 4\n");
  const std::vector<std::string> overrides = {"Camera.fx=400"};
  const LoadedSettings settings = LoadSettings(file, preset.string(), overrides);
  EXPECT_EQ(settings.options.camera.fx, 400.0);
  ASSERT_TRUE(settings.preset);
  EXPECT_EQ(settings.preset->file, preset);
  ASSERT_EQ(settings.notes.preset_overrides.size(), 1U);
  EXPECT_EQ(settings.notes.preset_overrides.front().key, "objects.pose.sigma");
  EXPECT_FALSE(settings.notes.warnings.empty()) << "the file replaces a setting of the preset";
}

TEST(LoadSettings, ACalibrationIsNamedInMessages) {
  const CameraCalibration calibration = {
      .camera = {.fx = 500, .fy = 500, .cx = 320, .cy = 240, .width = 640, .height = 480}};
  EXPECT_FALSE(LoadSettings(calibration, "sensor.yaml").preset);
  ExpectInputError([&] { LoadSettings(CameraCalibration(), "sensor.yaml"); }, {"sensor.yaml"});
  ExpectInputError([&] { LoadSettings(calibration, "sensor.yaml", "none"); }, {"none"});
}

}  // namespace
}  // namespace hullslam

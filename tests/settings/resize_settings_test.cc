// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/resize_settings.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

#include "hullslam/settings/settings.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

const PinholeCamera kCamera{
    .fx = 600.0, .fy = 610.0, .cx = 639.5, .cy = 355.0, .width = 1280, .height = 720, .bf = 40.0};

TEST(ResizeSettings, TheCameraIsThatOfTheResizedImages) {
  ResizeSettings resize;
  EXPECT_FALSE(resize.Changes(kCamera));
  EXPECT_TRUE(resize.Take("Camera.newWidth", "640", "f:1"));
  EXPECT_TRUE(resize.Take("Camera.newHeight", "360", "f:2"));
  EXPECT_FALSE(resize.Take("Camera.width", "640", "f:3"));
  const PinholeCamera resized = resize.Resized(kCamera);
  EXPECT_EQ(resized.width, 640);
  EXPECT_EQ(resized.height, 360);
  EXPECT_EQ(resized.fx, 300.0);
  EXPECT_EQ(resized.fy, 305.0);
  EXPECT_EQ(resized.bf, 20.0);
  EXPECT_EQ(resized.cx, 319.5);  // the middle of an image stays its middle
  EXPECT_TRUE(resize.Changes(kCamera));
  EXPECT_FALSE(resize.Changes(resized));
}

// The corner between pixels 1 and 2 of the large image is that between pixels 0 and 1 of the small.
TEST(ResizeSettings, PixelsCoverSquares) {
  ResizeSettings resize;
  EXPECT_TRUE(resize.Take("Camera.imageScale", "0.5", "f:1"));
  const PinholeCamera small = resize.Resized(kCamera);
  const Eigen::Vector3d ray = kCamera.Unproject({1.5, 1.5}, 1.0);
  EXPECT_LT((small.Project(ray) - Eigen::Vector2d(0.5, 0.5)).norm(), 1e-12);
}

TEST(ResizeSettings, BadValuesAreRefused) {
  ResizeSettings resize;
  ExpectInputError([&] { resize.Take("Camera.newWidth", "wide", "f.yaml:7"); },
                   {"f.yaml:7: Camera.newWidth is 'wide', expected a number from 16 to 16384"});
  ExpectInputError([&] { resize.Take("Camera.imageScale", "0", "f.yaml:7"); },
                   {"Camera.imageScale is '0'", "from 0.01 to 10"});
  resize.Take("Camera.newWidth", "640", "f:1");
  resize.Take("Camera.imageScale", "0.5", "f:2");
  ExpectInputError([&] { resize.Resized(kCamera); }, {"Camera.imageScale", "only one of them"});
}

TEST(ResizeSettings, TheReportHasTheSizeOfTheImagesAsRead) {
  const TemporaryFolder folder;
  const auto file =
      folder.Write("camera.yaml",
                   "Camera.fx: 600\nCamera.fy: 600\nCamera.cx: 639.5\nCamera.cy: 359.5\n"
                   "Camera.width: 1280\nCamera.height: 720\nCamera.imageScale: 0.5\n");
  SettingsNotes report;
  const SystemOptions options = ReadSettings(file, {}, report);
  EXPECT_EQ(options.camera.width, 640);
  EXPECT_EQ(options.camera.fx, 300.0);
  EXPECT_EQ(report.read_width, 1280);
  EXPECT_EQ(report.read_height, 720);
  SettingsNotes unchanged;
  const std::vector<std::string> overrides = {"Camera.imageScale=1"};
  EXPECT_EQ(ReadSettings(file, {.overrides = overrides}, unchanged).camera.cx, 639.5);
  EXPECT_EQ(unchanged.read_width, 0);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/options.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "hullslam/util/error.h"
#include "support/expect_error.h"
#include "system/make_sensor.h"

namespace hullslam {
namespace {

SystemOptions WithCamera() {
  SystemOptions options;
  options.camera.fx = 500.0;
  options.camera.fy = 500.0;
  return options;
}

TEST(SystemOptions, EveryDefaultIsInItsRange) {
  SystemOptions options = WithCamera();
  OptionTable table = options.Bind();
  for (const OptionTable::Entry& entry : table.Entries()) {
    EXPECT_NO_THROW(table.Set(entry.key, entry.value, "default")) << entry.key;
    EXPECT_FALSE(entry.help.empty()) << entry.key;
  }
  EXPECT_NO_THROW(options.Validate());
}

TEST(SystemOptions, OneMaskForAllImagesHasTheirSizeAndLeavesSomePixels) {
  SystemOptions options = WithCamera();
  options.mask_all = cv::Mat(480, 640, CV_8UC1, cv::Scalar(0));
  ExpectInputError([&] { options.Validate(); }, {"mask of all images", "0 everywhere"});
  options.mask_all.at<unsigned char>(3, 4) = 1;
  EXPECT_NO_THROW(options.Validate());
  EXPECT_EQ(MakeSensor(options).mask_all.at<unsigned char>(3, 4), 1);
  options.mask_all = cv::Mat(240, 320, CV_8UC1, cv::Scalar(255));
  ExpectInputError([&] { options.Validate(); }, {"320x240", "expected", "640x480"});
  options.mask_all = cv::Mat(480, 640, CV_8UC3, cv::Scalar(255));
  ExpectInputError([&] { options.Validate(); }, {"not CV_8UC1"});
  options.mask_all.release();
  options.mask_all_right = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
  ExpectInputError([&] { options.Validate(); }, {"right images", "stereo camera"});
  options.sensor = SensorKind::kStereo;
  EXPECT_NO_THROW(options.Validate());
  EXPECT_EQ(MakeSensor(options).mask_all_right.cols, 640);
  options.mask_all_right = cv::Mat(480, 600, CV_8UC1, cv::Scalar(255));
  ExpectInputError([&] { options.Validate(); }, {"right images", "600x480"});
}

TEST(SystemOptions, TheShutterMayReadInEachDirection) {
  SystemOptions options = WithCamera();
  OptionTable table = options.Bind();
  table.Set("Camera.readout_time", "-0.026", "test");
  table.Set("Camera.readout_direction", "columns", "test");
  EXPECT_EQ(MakeSensor(options).readout_time, -0.026);
  EXPECT_EQ(MakeSensor(options).readout_direction, ReadoutDirection::kColumns);
  for (const char* const time : {"nan", "-nan", "inf", "-0.11", "0.11"}) {
    EXPECT_THROW(table.Set("Camera.readout_time", time, "test"), InputError) << time;
  }
  EXPECT_THROW(table.Set("Camera.readout_direction", "diagonal", "test"), InputError);
}

TEST(SystemOptions, TheKeysOfOrbSlam2AreKnown) {
  SystemOptions options;
  const OptionTable table = options.Bind();
  for (const char* const key : {"Camera.fx",
                                "Camera.fy",
                                "Camera.cx",
                                "Camera.cy",
                                "Camera.k1",
                                "Camera.k2",
                                "Camera.p1",
                                "Camera.p2",
                                "Camera.k3",
                                "Camera.width",
                                "Camera.height",
                                "Camera.fps",
                                "Camera.bf",
                                "Camera.RGB",
                                "ThDepth",
                                "DepthMapFactor",
                                "ORBextractor.nFeatures",
                                "ORBextractor.scaleFactor",
                                "ORBextractor.nLevels",
                                "ORBextractor.iniThFAST",
                                "ORBextractor.minThFAST",
                                "Viewer.KeyFrameSize",
                                "Viewer.ViewpointF"}) {
    EXPECT_TRUE(table.Contains(key)) << key;
  }
}

TEST(SystemOptions, TheTableWritesIntoTheStruct) {
  SystemOptions options;
  OptionTable table = options.Bind();
  table.Set("Camera.fx", "123.5", "test");
  table.Set("DepthMapFactor", "1000", "test");
  table.Set("ORBextractor.nLevels", "4", "test");
  EXPECT_EQ(options.camera.fx, 123.5);
  EXPECT_EQ(options.depth.units_per_metre, 1000.0);
  EXPECT_EQ(options.features.level_count, 4);
}

TEST(SystemOptions, ACameraWithoutFocalLengthIsRefused) {
  const SystemOptions options;
  ExpectInputError([&] { options.Validate(); }, {"Camera.fx", "> 0"});
}

TEST(SystemOptions, LevelsSmallerThanAPatchAreRefused) {
  SystemOptions options = WithCamera();
  options.features.level_count = 20;
  ExpectInputError([&] { options.Validate(); },
                   {"ORBextractor.nLevels is '20'", "at most 12", "64 px"});
  options.camera.height = 60;
  ExpectInputError([&] { options.Validate(); }, {"640x60", "too small", "64 px"});
}

}  // namespace
}  // namespace hullslam

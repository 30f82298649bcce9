// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/options.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"

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
  ExpectInputError([&] { options.Validate(); }, {"ORBextractor.nLevels is '20'", "64 px"});
}

}  // namespace
}  // namespace hullslam

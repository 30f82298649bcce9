// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/feature_options.h"

#include <gtest/gtest.h>

#include <string>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

TEST(FeatureOptions, BindsTheKeysOfOrbSlam2) {
  FeatureOptions options;
  OptionTable table;
  options.Bind(table);
  table.Set("ORBextractor.nFeatures", "500", "test");
  table.Set("ORBextractor.scaleFactor", "1.5", "test");
  table.Set("ORBextractor.nLevels", "4", "test");
  table.Set("ORBextractor.iniThFAST", "25", "test");
  table.Set("ORBextractor.minThFAST", "9", "test");
  table.Set("ORBextractor.subpixel", "true", "test");
  EXPECT_TRUE(options.subpixel);
  EXPECT_EQ(options.feature_count, 500);
  EXPECT_EQ(options.scale_factor, 1.5);
  EXPECT_EQ(options.level_count, 4);
  EXPECT_EQ(options.initial_fast_threshold, 25);
  EXPECT_EQ(options.minimum_fast_threshold, 9);
}

TEST(FeatureOptions, RejectsValuesOutOfRange) {
  FeatureOptions options;
  OptionTable table;
  options.Bind(table);
  const auto is_refused = [&](const std::string& key, const std::string& value) {
    try {
      table.Set("ORBextractor." + key, value, "test.yaml:3");
    } catch (const InputError& error) {
      return std::string(error.what()).find(key) != std::string::npos;
    }
    return false;
  };
  for (const char* value : {"0", "-5", "100001", "1.5", "many"}) {
    EXPECT_TRUE(is_refused("nFeatures", value)) << value;
  }
  for (const char* value : {"1", "0.5", "2.1", "nan"}) {
    EXPECT_TRUE(is_refused("scaleFactor", value)) << value;
  }
  for (const char* value : {"0", "17"}) {
    EXPECT_TRUE(is_refused("nLevels", value)) << value;
  }
  for (const char* value : {"0", "256"}) {
    EXPECT_TRUE(is_refused("iniThFAST", value)) << value;
    EXPECT_TRUE(is_refused("minThFAST", value)) << value;
  }
}

}  // namespace
}  // namespace hullslam

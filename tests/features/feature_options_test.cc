// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/feature_options.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

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
  table.Set("ORBextractor.subpixel", "false", "test");
  table.Set("ORBextractor.keepEdges", "true", "test");
  EXPECT_FALSE(options.subpixel);
  EXPECT_TRUE(options.keep_edges);
  EXPECT_EQ(options.feature_count, 500);
  EXPECT_EQ(options.scale_factor, 1.5);
  EXPECT_EQ(options.level_count, 4);
  EXPECT_EQ(options.initial_fast_threshold, 25);
  EXPECT_EQ(options.minimum_fast_threshold, 9);
}

// The side of the smallest level, px.
double SmallestSide(int side, int levels) { return side / std::pow(1.2, levels - 1); }

TEST(FeatureOptions, TheUsualImageHasTheDefaults) {
  const FeatureOptions options;
  EXPECT_EQ(options.LevelsFor(640, 480), options.level_count);
  EXPECT_EQ(options.FeaturesFor(640, 480), options.feature_count);
}

TEST(FeatureOptions, TheSmallestLevelHasRoomForAPatch) {
  const FeatureOptions options;
  EXPECT_EQ(options.MostLevels(416, 128), 4);
  EXPECT_EQ(options.MostLevels(640, 480), 12);
  EXPECT_EQ(options.MostLevels(64, 64), 1);
  EXPECT_EQ(options.MostLevels(63, 480), 0);
  for (const int side : {64, 77, 128, 375, 480}) {
    const int most = options.MostLevels(1000, side);
    EXPECT_GE(SmallestSide(side, most), FeatureOptions::kSmallestSide) << side;
    EXPECT_LT(SmallestSide(side, most + 1), FeatureOptions::kSmallestSide) << side;
    EXPECT_LE(options.LevelsFor(1000, side), most) << side;
  }
  EXPECT_EQ(options.LevelsFor(416, 128), 4);
  EXPECT_EQ(options.LevelsFor(540, 360), 8) << "there is room for the usual levels";
}

TEST(FeatureOptions, ALargerImageHasMoreLevelsUntilItsCoarsestIsTheUsualOne) {
  const FeatureOptions options;
  const double usual = SmallestSide(480, options.level_count);
  for (const int height : {481, 720, 1080, 1440}) {
    const int levels = options.LevelsFor(height * 4 / 3, height);
    EXPECT_LE(SmallestSide(height, levels), usual + 1e-6) << height;
    EXPECT_GT(SmallestSide(height, levels), usual / 1.2) << height;
  }
  EXPECT_EQ(options.LevelsFor(20000, 20000), 16) << "the largest number that can be set";
}

// The number of features on the coarsest 8 levels; the number falls by 1.2 from level to level.
double FeaturesOfCoarsest(const FeatureOptions& options, int width, int height) {
  const int levels = options.LevelsFor(width, height);
  double share = 0.0;
  double all = 0.0;
  for (int level = 0; level < levels; ++level) {
    all += std::pow(1.2, -level);
    share += level >= levels - 8 ? std::pow(1.2, -level) : 0.0;
  }
  return options.FeaturesFor(width, height) * share / all;
}

TEST(FeatureOptions, ALargerImageHasTheUsualFeaturesOnItsCoarsestLevels) {
  const FeatureOptions options;
  for (const int height : {481, 720, 960, 1080}) {
    EXPECT_NEAR(FeaturesOfCoarsest(options, height * 4 / 3, height), 1000.0, 1.0) << height;
  }
}

TEST(FeatureOptions, AWideImageHasTheUsualFeaturesPerAreaOfTheseLevels) {
  const FeatureOptions options;
  for (const auto& [width, height] :
       {std::pair(1226, 370), std::pair(1920, 1080), std::pair(848, 480), std::pair(2560, 720)}) {
    const double scale = std::pow(1.2, options.LevelsFor(width, height) - 8);
    const double area = (width / scale) * (height / scale);
    EXPECT_GT(area, 640.0 * 480.0);
    EXPECT_NEAR(FeaturesOfCoarsest(options, width, height) / area, 1000.0 / (640.0 * 480.0), 1e-5)
        << width << "x" << height;
    EXPECT_EQ(options.FeaturesFor(width, height), options.FeaturesFor(height, width));
  }
  EXPECT_EQ(options.FeaturesFor(1226, 370), 1477);
  EXPECT_EQ(options.FeaturesFor(640, 400), 1000) << "no fewer than in a usual image";
}

TEST(FeatureOptions, ASmallerImageHasMoreFeaturesBecauseItsPixelsAreLargerAngles) {
  const FeatureOptions options;
  EXPECT_EQ(options.FeaturesFor(320, 240), 4000);
  EXPECT_EQ(options.FeaturesFor(240, 320), 4000) << "the same image upright";
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

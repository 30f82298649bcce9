// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/feature_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

TEST(HammingDistance, CountsDifferentBits) {
  const Descriptor zero{};
  const Descriptor ones{~0ull, ~0ull, ~0ull, ~0ull};
  const Descriptor few{1ull, 1ull << 63, 0b1010ull, 0ull};
  EXPECT_EQ(HammingDistance(zero, zero), 0);
  EXPECT_EQ(HammingDistance(zero, ones), 256);
  EXPECT_EQ(HammingDistance(zero, few), 4);
  EXPECT_EQ(HammingDistance(few, ones), 252);
}

TEST(ScaleLevels, AreAGeometricSeries) {
  const ScaleLevels levels = ScaleLevels::Create(8, 1.2);
  ASSERT_EQ(levels.count(), 8);
  EXPECT_EQ(levels.scale[0], 1.0f);
  EXPECT_FLOAT_EQ(levels.scale[2], 1.44f);
  EXPECT_FLOAT_EQ(levels.scale[7], 3.5831808f);
  EXPECT_FLOAT_EQ(levels.log_factor, std::log(1.2f));
  for (size_t l = 0; l < 8; ++l) {
    EXPECT_FLOAT_EQ(levels.sigma2[l], levels.scale[l] * levels.scale[l]);
    EXPECT_FLOAT_EQ(levels.sigma2[l] * levels.inverse_sigma2[l], 1.0f);
  }
}

TEST(ScaleLevels, RejectsInvalidPyramids) {
  EXPECT_THROW(ScaleLevels::Create(0, 1.2), CheckError);
  EXPECT_THROW(ScaleLevels::Create(8, 1.0), CheckError);
  EXPECT_THROW(ScaleLevels::Create(8, std::numeric_limits<double>::quiet_NaN()), CheckError);
}

// A landmark that is seen at level l from distance d is seen at level 0 from distance d scale[l].
TEST(ScaleLevels, PredictsTheLevelAtWhichALandmarkWasSeen) {
  const ScaleLevels levels = ScaleLevels::Create(8, 1.2);
  for (const double distance : {0.3, 1.0, 4.7}) {
    for (int l = 0; l < 8; ++l) {
      const double max_distance =
          distance * static_cast<double>(levels.scale[static_cast<size_t>(l)]);
      EXPECT_EQ(levels.PredictLevel(distance, max_distance), l);
    }
  }
}

TEST(ScaleLevels, PredictsTheUpperOfTwoLevelsAndClamps) {
  const ScaleLevels levels = ScaleLevels::Create(8, 1.2);
  EXPECT_EQ(levels.PredictLevel(1.0, 1.1), 1);
  EXPECT_EQ(levels.PredictLevel(1.0, 1.21), 2);
  EXPECT_EQ(levels.PredictLevel(1.0, 0.2), 0);
  EXPECT_EQ(levels.PredictLevel(1.0, 100.0), 7);
  EXPECT_EQ(levels.PredictLevel(1e-300, 1e300), 7);
  EXPECT_THROW(levels.PredictLevel(0.0, 1.0), CheckError);
  EXPECT_THROW(levels.PredictLevel(1.0, -1.0), CheckError);
}

}  // namespace
}  // namespace hullslam

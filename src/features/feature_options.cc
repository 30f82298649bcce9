// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/feature_options.h"

namespace hullslam {

void FeatureOptions::Bind(OptionTable& options) {
  const OptionScope scope(options, "ORBextractor");
  scope.Add("nFeatures", &feature_count, Range::Between(1, 50000),
            "number of features to extract from an image");
  scope.Add("scaleFactor", &scale_factor, {.low = 1.0, .high = 2.0, .low_open = true},
            "ratio of the sizes of neighbouring levels of the image pyramid");
  scope.Add("nLevels", &level_count, Range::Between(1, 16),
            "number of levels of the image pyramid");
  scope.Add("iniThFAST", &initial_fast_threshold, Range::Between(1, 255),
            "FAST threshold, grey levels");
  scope.Add("minThFAST", &minimum_fast_threshold, Range::Between(1, 255),
            "FAST threshold in regions without corners at the first threshold, grey levels");
  scope.Add("subpixel", &subpixel,
            "refine the positions of features within a pixel of their level");
}

}  // namespace hullslam

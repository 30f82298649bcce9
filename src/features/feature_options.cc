// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/feature_options.h"

#include <algorithm>
#include <cmath>

namespace hullslam {
namespace {

// The size of images for which the defaults were chosen, px.
constexpr double kUsualWidth = 640.0;
constexpr double kUsualHeight = 480.0;

}  // namespace

int FeatureOptions::MostLevels(int width, int height) const {
  const double ratio = std::min(width, height) / static_cast<double>(kSmallestSide);
  return ratio < 1.0 ? 0 : 1 + static_cast<int>(std::log(ratio) / std::log(scale_factor));
}

// In a larger image a patch covers less of the scene. So there are more levels, until the coarsest
// one is not larger than in a usual image. A smaller image keeps the usual levels as long as
// it has room for them.
int FeatureOptions::LevelsFor(int width, int height) const {
  constexpr int kMostOfTable = 16;  // the range of ORBextractor.nLevels
  const double enlargement = std::max(1.0, std::min(width, height) / kUsualHeight);
  // The tolerance keeps rounding errors from adding a level.
  const double added = std::ceil(std::log(enlargement) / std::log(scale_factor) - 1e-9);
  const int wanted = std::min(FeatureOptions().level_count + static_cast<int>(added), kMostOfTable);
  return std::clamp(wanted, 1, std::max(1, MostLevels(width, height)));
}

// The number of features grows by the scale factor from level to finer level. In a larger image,
// the coarsest 8 levels show what a usual image shows, and the finer ones have their features in
// addition. These 8 levels have the usual number of features per area, so a wide image has more of
// them, which tell of the left and the right what a usual image does not show; but never fewer than
// a usual image. In a smaller image a pixel is a larger angle, so each landmark is less precise.
// N landmarks give a pose the precision of one landmark over the root of N, so N grows with the
// square of the angle.
int FeatureOptions::FeaturesFor(int width, int height) const {
  const FeatureOptions usual;
  const auto sum = [this](int count) { return std::pow(scale_factor, count) - 1.0; };
  const int levels = std::max(LevelsFor(width, height), usual.level_count);
  const double enlargement = std::pow(scale_factor, levels - usual.level_count);
  const double area =
      std::max(1.0, (width / enlargement) * (height / enlargement) / (kUsualWidth * kUsualHeight));
  const double angle = std::max(1.0, kUsualWidth / std::max(width, height));
  return static_cast<int>(std::lround(usual.feature_count * area * sum(levels) /
                                      sum(usual.level_count) * angle * angle));
}

void FeatureOptions::Bind(OptionTable& options) {
  const OptionScope scope(options, "ORBextractor");
  scope.Add("nFeatures", &feature_count, Range::Between(1, 50000),
            "number of features to extract from an image; without this key, more than 1000 if the "
            "image is larger or smaller than 640x480 px");
  scope.Add("scaleFactor", &scale_factor, {.low = 1.0, .high = 2.0, .low_open = true},
            "ratio of the sizes of neighbouring levels of the image pyramid");
  scope.Add("nLevels", &level_count, Range::Between(1, 16),
            "number of levels of the image pyramid; without this key, more than 8 if the image is "
            "larger than 640x480 px, and fewer if it is too small for them");
  scope.Add("iniThFAST", &initial_fast_threshold, Range::Between(1, 255),
            "FAST threshold, grey levels");
  scope.Add("minThFAST", &minimum_fast_threshold, Range::Between(1, 255),
            "FAST threshold in regions without corners at the first threshold, grey levels");
  scope.Add("subpixel", &subpixel,
            "refine the positions of features within a pixel of their level");
  scope.Add("keepEdges", &keep_edges,
            "monocular: keep features on straight edges, which look alike along the edge");
}

}  // namespace hullslam

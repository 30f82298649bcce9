// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sources/pixel_pairs.h"

#include <cstddef>

namespace hullslam {
namespace {

double SigmaOf(const Keypoint& keypoint, const ScaleLevels& levels) {
  return static_cast<double>(levels.scale[static_cast<size_t>(keypoint.level)]);
}

}  // namespace

std::vector<PixelPair> MakePixelPairs(const FrameFeatures& a, const FrameFeatures& b,
                                      std::span<const Match> matches, const ScaleLevels& levels) {
  std::vector<PixelPair> pairs;
  pairs.reserve(matches.size());
  for (const Match& match : matches) {
    const Keypoint& in_a = a.keypoints[match.query];
    const Keypoint& in_b = b.keypoints[match.keypoint];
    pairs.push_back({.a = in_a.undistorted.cast<double>(),
                     .b = in_b.undistorted.cast<double>(),
                     .sigma_a = SigmaOf(in_a, levels),
                     .sigma_b = SigmaOf(in_b, levels)});
  }
  return pairs;
}

}  // namespace hullslam

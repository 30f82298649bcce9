// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/keypoint_weights.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "util/statistics.h"

namespace hullslam::internal {
namespace {

constexpr float kRadius = 3.0f;  // px

constexpr double kMedianChi2 = 1.386;  // median for two degrees of freedom: 2 ln 2
constexpr double kMaxFactor = 2.0;     // largest factor on OutlierBound
constexpr double kMaxPrecision = 5.0;
constexpr size_t kMinErrors = 100;  // least number of errors for a reliable median

}  // namespace

std::vector<double> KeypointWeights(const Keyframe& keyframe, const ScaleLevels& levels) {
  const FrameFeatures& features = keyframe.frame->features;
  std::vector<double> weights(features.size(), 0.0);
  GridSearch grid(features.grid, features.keypoints);
  for (size_t keypoint = 0; keypoint < weights.size(); ++keypoint) {
    if (!keyframe.landmarks[keypoint].IsValid()) {
      continue;
    }
    const std::span<const uint32_t> near =
        grid.FindNear(features.grid.PositionOf(features.keypoints, static_cast<uint32_t>(keypoint)),
                      kRadius, 0, std::numeric_limits<int>::max());
    double most = 0.0;
    double sum = 0.0;
    for (const uint32_t i : near) {
      if (keyframe.landmarks[i].IsValid()) {
        const auto level = static_cast<size_t>(features.keypoints[i].level);
        const auto information = static_cast<double>(levels.inverse_sigma2[level]);
        most = std::max(most, information);
        sum += information;
      }
    }
    weights[keypoint] = sum > 0.0 ? most / sum : 1.0;
  }
  return weights;
}

double MeasureKeypointPrecision(std::vector<double> chi2, size_t points, double precision) {
  if (chi2.size() < kMinErrors) {
    return precision;
  }
  const double equations = 2.0 * static_cast<double>(chi2.size());
  const double free_share = std::max(0.3, 1.0 - 3.0 * static_cast<double>(points) / equations);
  const double sigma = std::sqrt(Median(std::move(chi2)) / (kMedianChi2 * free_share)) / precision;
  return std::clamp(1.0 / sigma, 1.0, kMaxPrecision);
}

double OutlierBoundFactor(double precision) { return std::min(kMaxFactor, precision * precision); }

}  // namespace hullslam::internal

// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/keypoint_depth.h"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <numbers>

namespace hullslam {
namespace {

constexpr double kReach = 3.0;  // px at the level of the keypoint; the circle of FAST
constexpr double kDiagonal = kReach / std::numbers::sqrt2;
// px, of the disparity of a virtual stereo pair. That of a first Kinect has an error of 0.06 px
// with bf = 40 (Khoshelham and Elberink 2012), the mean of two less that of a third one 0.07 px.
constexpr double kMostBend = 0.3;

// Half of the circle; the other points are opposite to these.
constexpr std::array<std::array<double, 2>, 4> kHalfCircle = {
    {{kReach, 0.0}, {kDiagonal, kDiagonal}, {0.0, kReach}, {-kDiagonal, kDiagonal}}};

}  // namespace

float KeypointDepth(const cv::Mat& depth, const RawKeypoint& keypoint, double scale, double bf,
                    const DepthOptions& options) {
  const auto sample = [&](const Eigen::Vector2f& raw) {
    return SampleDepth(depth, raw, options.units_per_metre);
  };
  const float centre = sample(keypoint.raw);
  if (centre <= 0.0F || options.error.model == DepthErrorModel::kRightColumn) {
    return centre;
  }
  for (const auto& point : kHalfCircle) {
    const Eigen::Vector2f offset = (scale * Eigen::Vector2d(point[0], point[1])).cast<float>();
    const auto one = static_cast<double>(sample(keypoint.raw + offset));
    const auto other = static_cast<double>(sample(keypoint.raw - offset));
    if (one > 0.0 && other > 0.0) {
      const double bend = 0.5 * (1.0 / one + 1.0 / other) - 1.0 / static_cast<double>(centre);
      if (bf * std::abs(bend) > kMostBend) {
        return 0.0F;
      }
    }
  }
  return centre;
}

}  // namespace hullslam

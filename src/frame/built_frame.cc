// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/built_frame.h"

#include <array>

namespace hullslam {

std::string ToString(DetectionRejection reason) {
  constexpr std::array<const char*, kDetectionRejectionCount> kNames = {
      "low_score",     "degenerate", "too_small",     "too_large",
      "few_keypoints", "duplicate",  "no_silhouette", "not_in_left"};
  return kNames.at(static_cast<size_t>(reason));
}

void DetectionCounts::Add(const DetectionCounts& other) {
  detections += other.detections;
  right_masks += other.right_masks;
  frames_with_masks += other.frames_with_masks;
  for (const auto& [reason, count] : other.rejections) {
    rejections[reason] += count;
  }
}

}  // namespace hullslam

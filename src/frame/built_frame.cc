// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/built_frame.h"

namespace hullslam {

void DetectionCounts::Add(const DetectionCounts& other) {
  detections += other.detections;
  frames_with_masks += other.frames_with_masks;
  for (const auto& [reason, count] : other.rejections) {
    rejections[reason] += count;
  }
}

}  // namespace hullslam

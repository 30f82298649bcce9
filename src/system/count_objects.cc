// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/count_objects.h"

namespace hullslam {

ObjectCounts CountObjects(const DetectionCounts& masks, size_t frames,
                          const std::map<ObjectRejection, size_t>& rejections) {
  ObjectCounts counts;
  counts.detections = masks.detections;
  counts.frames_with_masks = masks.frames_with_masks;
  counts.frames_without_masks = frames - masks.frames_with_masks;
  for (const auto& [reason, count] : masks.rejections) {
    counts.rejections["mask_" + ToString(reason)] = count;
  }
  for (const auto& [reason, count] : rejections) {
    counts.rejections[ToString(reason)] = count;
  }
  return counts;
}

}  // namespace hullslam

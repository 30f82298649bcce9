// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/masks/mask_source.h"

#include "masks/mask_checks.h"

namespace hullslam {

std::vector<MaskFrame> MaskFrames(const ImageSequence& sequence) {
  std::vector<MaskFrame> frames;
  for (const FramePaths& frame : sequence.frames) {
    frames.push_back({ImageStem(frame.image.string()), frame.number});
  }
  return frames;
}

MaskCounts CheckMasks(const MaskSource& source, std::span<const MaskFrame> frames) {
  MaskCounts counts;
  for (const MaskFrame& frame : frames) {
    const FrameMasks masks = source.Read(frame);
    counts.missing += masks.is_missing ? 1 : 0;
    counts.without_masks += masks.masks.empty() ? 1 : 0;
  }
  return counts;
}

}  // namespace hullslam

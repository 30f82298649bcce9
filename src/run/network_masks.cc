// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/network_masks.h"

#include <algorithm>

#include "hullslam/util/check.h"
#include "masks/yolo_text.h"
#include "sequences/frame_colour.h"

namespace hullslam {

NetworkMasks::NetworkMasks(const std::filesystem::path& network, const SegmenterOptions& options,
                           size_t every, const ImageSequence& sequence, const PinholeCamera& camera)
    : segmenter_(network, options), every_(every), sequence_(sequence), camera_(camera) {}

FrameMasks NetworkMasks::Read(const MaskFrame& frame) const {
  const auto found =
      std::ranges::lower_bound(sequence_.frames, frame.number, {}, &FramePaths::number);
  Check(found != sequence_.frames.end() && found->number == frame.number, "no such frame");
  const auto index = static_cast<size_t>(found - sequence_.frames.begin());
  if (!IsRead(index)) {
    return {.masks = {}, .rows = {}, .is_missing = true};
  }
  return {.masks = Make(LoadImage(index)), .rows = {}};
}

cv::Mat NetworkMasks::LoadImage(size_t frame) const {
  return LoadColour(sequence_, sequence_.frames.at(frame), camera_);
}

std::vector<InstanceMask> NetworkMasks::Make(const cv::Mat& image) const {
  const std::lock_guard lock(mutex_);
  std::vector<InstanceMask> masks = segmenter_.Segment(image);
  RoundAsYoloText(image.size(), masks);
  return masks;
}

}  // namespace hullslam

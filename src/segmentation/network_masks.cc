// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/segmentation/network_masks.h"

#include <algorithm>

#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "masks/yolo_text.h"
#include "sequences/image_list.h"

namespace hullslam {

NetworkMasks::NetworkMasks(const std::filesystem::path& network, const SegmenterOptions& options,
                           size_t every, const ImageSequence& sequence, const PinholeCamera& camera)
    : segmenter_(network, options),
      path_(network),
      every_(every),
      sequence_(sequence),
      camera_(camera) {}

FrameMasks NetworkMasks::Read(const MaskFrame& frame) const {
  const auto found =
      std::ranges::lower_bound(sequence_.frames, frame.number, {}, &FramePaths::number);
  Check(found != sequence_.frames.end() && found->number == frame.number, "no such frame");
  const auto index = static_cast<size_t>(found - sequence_.frames.begin());
  if (!IsRead(index)) {
    return {.masks = {}, .rows = {}, .is_missing = true};
  }
  std::optional<std::vector<InstanceMask>> masks = Make(LoadImage(index));
  return {.masks = masks ? *std::move(masks) : std::vector<InstanceMask>(),
          .rows = {},
          .is_missing = !masks};
}

cv::Mat NetworkMasks::LoadImage(size_t frame) const {
  return LoadColour(sequence_, sequence_.frames.at(frame), camera_);
}

std::optional<std::vector<InstanceMask>> NetworkMasks::Make(const cv::Mat& image) const {
  const std::lock_guard lock(mutex_);
  const ScopedTimer timer(work_.times, "segment");
  try {
    std::vector<InstanceMask> masks = segmenter_.Segment(image);
    RoundAsYoloText(image.size(), masks);
    return masks;
  } catch (const InputError& error) {
    if (work_.failures++ == 0) {
      work_.first_failure = error.what();
    }
    return std::nullopt;
  }
}

NetworkMasks::Work NetworkMasks::work() const {
  const std::lock_guard lock(mutex_);
  return work_;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/reduced_frame.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "frame/rolling_shutter.h"

namespace hullslam {
namespace {

// The positions in `kept` of those `indices` that it contains. Both increase.
std::vector<uint32_t> PositionsIn(std::span<const uint32_t> kept,
                                  const std::vector<uint32_t>& indices) {
  std::vector<uint32_t> positions;
  for (const uint32_t index : indices) {
    const auto it = std::lower_bound(kept.begin(), kept.end(), index);
    if (it != kept.end() && *it == index) {
      positions.push_back(static_cast<uint32_t>(it - kept.begin()));
    }
  }
  positions.shrink_to_fit();
  return positions;
}

}  // namespace

std::shared_ptr<const Frame> ReduceFrame(const Frame& frame, std::span<const uint32_t> keypoints,
                                         std::span<const uint32_t> detections) {
  auto reduced = std::make_shared<Frame>();
  reduced->id = frame.id;
  reduced->timestamp = frame.timestamp;
  reduced->features = SelectKeypoints(frame.features, keypoints);
  for (const uint32_t keypoint : keypoints) {
    if (!frame.words.empty()) {
      reduced->words.push_back(frame.words.at(keypoint));
    }
  }
  if (frame.shutter != nullptr) {
    auto shutter = std::make_shared<ShutterMotion>();
    shutter->velocity = frame.shutter->velocity;
    for (const uint32_t keypoint : keypoints) {
      shutter->inverse_depths.push_back(frame.shutter->inverse_depths.at(keypoint));
    }
    reduced->shutter = std::move(shutter);
  }
  reduced->detections.reserve(detections.size());
  for (const uint32_t index : detections) {
    Detection& detection = reduced->detections.emplace_back(frame.detections.at(index));
    detection.keypoints = PositionsIn(keypoints, detection.keypoints);
  }
  return reduced;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/reduced_frame.h"

#include <algorithm>
#include <vector>

namespace hullslam {
namespace {

// The places in `kept` of those `indices` that are there. Both increase.
std::vector<uint32_t> PlacesIn(std::span<const uint32_t> kept,
                               const std::vector<uint32_t>& indices) {
  std::vector<uint32_t> places;
  for (const uint32_t index : indices) {
    const auto it = std::lower_bound(kept.begin(), kept.end(), index);
    if (it != kept.end() && *it == index) {
      places.push_back(static_cast<uint32_t>(it - kept.begin()));
    }
  }
  places.shrink_to_fit();
  return places;
}

}  // namespace

std::shared_ptr<const Frame> ReduceFrame(const Frame& frame, std::span<const uint32_t> keypoints,
                                         std::span<const uint32_t> detections) {
  auto reduced = std::make_shared<Frame>();
  reduced->id = frame.id;
  reduced->timestamp = frame.timestamp;
  reduced->features = SelectKeypoints(frame.features, keypoints);
  reduced->detections.reserve(detections.size());
  for (const uint32_t index : detections) {
    Detection& detection = reduced->detections.emplace_back(frame.detections.at(index));
    detection.keypoints = PlacesIn(keypoints, detection.keypoints);
  }
  return reduced;
}

}  // namespace hullslam

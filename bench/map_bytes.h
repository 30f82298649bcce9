// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "hullslam/map/map.h"

namespace hullslam {
namespace bytes_internal {

constexpr size_t kOverhead = 8;  // that the allocator needs per block

template <typename Vector>
size_t Block(const Vector& vector) {
  const size_t bytes = vector.capacity() * sizeof(typename Vector::value_type);
  return bytes > 0 ? bytes + kOverhead : 0;
}

// Packed points reserve exactly what they need.
template <int N>
size_t Block(const PackedPoints<N>& points) {
  return points.empty() ? 0 : points.size() * PackedPoints<N>::kBytesPerPoint + kOverhead;
}

}  // namespace bytes_internal

// What the keyframes and the objects of a map take on the heap, in bytes by part. Memory that a
// vector has reserved but does not use counts.
inline std::map<std::string, size_t> KeyframeBytes(const Map& map) {
  using bytes_internal::Block;
  std::map<std::string, size_t> bytes;
  for (const auto& [id, keyframe] : map.keyframes()) {
    const Frame& frame = *keyframe.frame;
    const FrameFeatures& features = frame.features;
    bytes["keyframe and frame themselves"] +=
        sizeof(Keyframe) + sizeof(Frame) + 2 * bytes_internal::kOverhead;
    bytes["ids of landmarks and objects"] += Block(keyframe.landmarks) + Block(keyframe.objects);
    bytes["covisibility and tree"] +=
        Block(keyframe.covisible) + Block(keyframe.children) + Block(keyframe.loops);
    bytes["keypoints"] += Block(features.keypoints);
    bytes["descriptors"] += Block(features.descriptors);
    bytes["depths"] += Block(features.depth);
    bytes["feature grid"] +=
        sizeof(uint16_t) * (features.size() + 32 * 24 + 1) + 2 * bytes_internal::kOverhead;
    bytes["depth grid"] +=
        sizeof(uint16_t) * static_cast<size_t>(frame.depth.columns() * frame.depth.rows());
    bytes["detections themselves"] += Block(frame.detections);
    for (const Detection& detection : frame.detections) {
      bytes["contours"] += Block(detection.contour);
      bytes["hulls"] += Block(detection.hull);
      bytes["lines"] += Block(detection.lines);
      bytes["depth points"] += Block(detection.points);
      bytes["keypoint indices"] += Block(detection.keypoints);
    }
  }
  for (const auto& [id, object] : map.objects()) {
    bytes["objects"] += sizeof(ObjectLandmark) + Block(object.observations);
    bytes["misfit samples of objects"] += Block(object.misfit_samples);
  }
  return bytes;
}

}  // namespace hullslam

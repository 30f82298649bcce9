// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

inline constexpr uint32_t kFramesPerKeyframe = 3;
inline constexpr uint32_t kDetections = 4;  // a frame: cup, book, cup, book, of scores that differ

// A frame of `keypoints` keypoints at level 0, of which the first `with_depth` have a depth of 2 m.
inline std::shared_ptr<Frame> MakeFrame(uint32_t id, size_t keypoints, size_t with_depth = 0) {
  auto frame = std::make_shared<Frame>();
  frame->id = FrameId(id);
  FrameFeatures& features = frame->features;
  features.keypoints.resize(keypoints);
  features.descriptors.resize(keypoints);
  for (size_t i = 0; i < keypoints; ++i) {
    const auto x = static_cast<float>(30 + i);
    features.keypoints[i].undistorted = {x, 100.0f};
    features.depth.push_back(i < with_depth ? 2.0f : 0.0f);
    features.right_u.push_back(i < with_depth ? x - 20.0f : -1.0f);
  }
  frame->detections.resize(kDetections);
  for (uint32_t i = 0; i < kDetections; ++i) {
    frame->detections[i].label = i % 2 == 0 ? "cup" : "book";
    frame->detections[i].score = 0.3 + 0.1 * i;
  }
  return frame;
}

// A keyframe of every third frame.
inline KeyframeId AddKeyframe(Map& map, size_t keypoints, size_t with_depth = 0,
                              const Rigid3& cam_from_world = {}) {
  const uint32_t frame = kFramesPerKeyframe * map.keyframes().NextId().value;
  return map.AddKeyframe(MakeFrame(frame, keypoints, with_depth), cam_from_world);
}

// New landmarks that all of these keyframes observe, each at its first free keypoint.
inline std::vector<LandmarkId> Share(Map& map, const std::vector<KeyframeId>& keyframes,
                                     int count = 1) {
  std::vector<LandmarkId> added;
  for (int i = 0; i < count; ++i) {
    const LandmarkId landmark = map.AddLandmark({0.0, 0.0, 2.0}, keyframes.front());
    for (const KeyframeId id : keyframes) {
      const std::vector<LandmarkId>& slots = map.keyframes().At(id).landmarks;
      const auto free = std::find(slots.begin(), slots.end(), LandmarkId());
      map.AddObservation(landmark, id, static_cast<uint32_t>(std::distance(slots.begin(), free)));
    }
    added.push_back(landmark);
  }
  return added;
}

// All that a map holds, to compare maps by.
inline std::string Dump(const Map& map) {
  std::ostringstream out;
  out.precision(17);
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    out << "\nkeyframe " << id.value << " frame " << keyframe.frame->id.value << " pose "
        << keyframe.cam_from_world.ToMatrix().reshaped().transpose() << " parent "
        << keyframe.parent.value << " children";
    for (const KeyframeId child : keyframe.children) {
      out << ' ' << child.value;
    }
    for (const Covisible& edge : keyframe.covisible) {
      out << " edge " << edge.keyframe.value << ':' << edge.shared;
    }
    for (const LandmarkId landmark : keyframe.landmarks) {
      out << ' ' << landmark.value;
    }
  });
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    out << "\nobject " << id.value << ' ' << object.visible << ' ' << object.found;
    for (const auto& [label, votes] : object.votes) {
      out << ' ' << label << ':' << votes;
    }
    for (const ObjectObservation& observation : object.observations) {
      out << ' ' << observation.keyframe.value << ':' << observation.detection;
    }
  });
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    out << "\nlandmark " << id.value << ' ' << landmark.position.transpose() << " reference "
        << landmark.reference.value << ' ' << landmark.support << ' ' << landmark.visible << ' '
        << landmark.found;
    for (const Observation& observation : landmark.observations) {
      out << ' ' << observation.keyframe.value << ':' << observation.keypoint;
    }
  });
  for (uint32_t i = 0; i < map.landmarks().NextId().value; ++i) {
    out << ' ' << map.Resolve(LandmarkId(i)).value;
  }
  for (uint32_t i = 0; i < map.keyframes().NextId().value; ++i) {
    out << ' ' << map.NearestAlive(KeyframeId(i)).value << ' '
        << map.CamFromWorld(KeyframeId(i)).translation.transpose();
  }
  return std::move(out).str();
}

}  // namespace hullslam

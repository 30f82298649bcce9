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
inline constexpr uint32_t kDetections = 4;  // per frame: cup, book, cup, book with different scores

inline std::vector<KeyframeId> KeyframeIds(const std::vector<uint32_t>& numbers) {
  return {numbers.begin(), numbers.end()};
}

// A frame of `keypoints` keypoints at level 0, of which the first `with_depth` have a depth of 2 m.
inline std::shared_ptr<Frame> MakeFrame(uint32_t id, size_t keypoints, size_t with_depth = 0) {
  auto frame = std::make_shared<Frame>();
  frame->id = FrameId(id);
  frame->motion = MotionPrior();
  FrameFeatures& features = frame->features;
  features.keypoints.resize(keypoints);
  features.descriptors.resize(keypoints);
  for (size_t i = 0; i < keypoints; ++i) {
    const auto x = static_cast<float>(30 + i);
    features.keypoints[i].undistorted = {x, 100.0f};
    features.depth.push_back(i < with_depth ? 2.0f : 0.0f);
  }
  frame->detections.resize(kDetections);
  for (uint32_t i = 0; i < kDetections; ++i) {
    frame->detections[i].label = i % 2 == 0 ? "cup" : "book";
    frame->detections[i].score = 0.3 + 0.1 * i;
  }
  return frame;
}

// Adds a keyframe. Only every third frame number is used. If the map has a vocabulary, the frame
// has words.
inline KeyframeId AddKeyframe(Map& map, size_t keypoints, size_t with_depth = 0,
                              const Rigid3& cam_from_world = {}) {
  const uint32_t number = kFramesPerKeyframe * map.keyframes().NextId().value;
  const auto frame = MakeFrame(number, keypoints, with_depth);
  if (map.vocabulary() != nullptr) {
    std::vector<WordId> words;
    for (uint32_t i = 0; i < keypoints; ++i) {
      const auto word_count = static_cast<uint32_t>(map.vocabulary()->word_count());
      words.emplace_back((number + i * i) % word_count);
    }
    frame->words = std::move(words);
  }
  return map.AddKeyframe(frame, cam_from_world);
}

// Adds landmarks that all these keyframes observe, each keyframe at its first free keypoint.
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

inline void Dump(const Rigid3& pose, std::ostream& out) {
  out << ' ' << pose.rotation.coeffs().transpose() << ' ' << pose.translation.transpose();
}

inline void Dump(const ObjectLandmark& object, std::ostream& out) {
  out << " state " << static_cast<int>(object.state) << ' ' << object.has_shape << ' '
      << object.shaped_views << " reference " << object.reference.value;
  for (const Ellipsoid& ellipsoid : {object.ellipsoid, object.start}) {
    Dump(ellipsoid.world_from_object, out);
    out << ' ' << ellipsoid.half_axes.transpose();
  }
  for (const auto& sample : object.misfit_samples) {
    out << " sample " << sample.normal.transpose() << ' ' << sample.excess << ' '
        << sample.keyframe.value;
  }
  out << " counts " << object.visible << ' ' << object.found;
  for (const auto& [label, votes] : object.votes) {
    out << ' ' << label << ':' << votes;
  }
  for (const ObjectObservation& observation : object.observations) {
    out << ' ' << observation.keyframe.value << ':' << observation.detection;
  }
}

inline void Dump(const Landmark& landmark, std::ostream& out) {
  out << ' ' << landmark.position.transpose() << " from " << landmark.viewing_direction.transpose()
      << ' ' << landmark.min_distance << ' ' << landmark.max_distance << " reference "
      << landmark.reference.value << ' ' << landmark.observation_weight << ' ' << landmark.visible
      << ' ' << landmark.found << " descriptor";
  for (const uint64_t word : landmark.descriptor) {
    out << ' ' << word;
  }
  for (const Observation& observation : landmark.observations) {
    out << ' ' << observation.keyframe.value << ':' << observation.keypoint;
  }
}

// Everything in a map except the number of its corrections as text, to compare maps. 17 digits
// distinguish any two doubles.
inline std::string Dump(const Map& map) {
  std::ostringstream out;
  out.precision(17);
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    out << "\nkeyframe " << id.value << " frame " << keyframe.frame->id.value << " pose";
    Dump(keyframe.cam_from_world, out);
    out << " island " << keyframe.island.value << " scale " << keyframe.scale << " parent "
        << keyframe.parent.value << " children";
    for (const KeyframeId child : keyframe.children) {
      out << ' ' << child.value;
    }
    for (const KeyframeId loop : keyframe.loops) {
      out << " loop " << loop.value;
    }
    for (const Covisible& edge : keyframe.covisible) {
      out << " edge " << edge.keyframe.value << ':' << edge.shared;
    }
    for (const LandmarkId landmark : keyframe.landmarks) {
      out << ' ' << landmark.value;
    }
    for (const ObjectId object : keyframe.objects) {
      out << ' ' << object.value;
    }
  });
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    out << "\nobject " << id.value;
    Dump(object, out);
  });
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    out << "\nlandmark " << id.value;
    Dump(landmark, out);
  });
  for (uint32_t slot = 0; slot < map.landmarks().slots(); ++slot) {
    for (uint32_t generation = 0; generation < 4; ++generation) {
      out << ' ' << map.Resolve(LandmarkId(slot, generation)).value;
    }
  }
  for (uint32_t i = 0; i < map.objects().NextId().value; ++i) {
    out << ' ' << map.Resolve(ObjectId(i)).value;
  }
  for (uint32_t i = 0; i < map.keyframes().NextId().value; ++i) {
    if (const CulledKeyframe* culled = map.FindCulled(KeyframeId(i))) {
      out << "\nculled " << i << " frame " << culled->frame.value << " reference "
          << culled->pose.reference.value;
      Dump(culled->pose.cam_from_reference, out);
      out << " scale " << culled->pose.reference_scale << ' ' << culled->scale;
    }
  }
  return std::move(out).str();
}

}  // namespace hullslam

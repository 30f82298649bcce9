// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "map/keyframe_graph.h"
#include "map/made_map.h"
#include "support/made_vocabulary.h"

namespace hullslam {

// An empty map with the shared vocabulary.
inline Map MakeWordMap() { return Map(SharedVocabulary()); }

// Adds a keyframe with `landmarks` keypoints, whose words are `words` in turn.
inline KeyframeId AddWords(Map& map, const std::vector<uint32_t>& words, size_t landmarks = 100) {
  const auto frame = MakeFrame(map.keyframes().NextId().value, landmarks);
  std::vector<WordId> of_keypoints;
  for (size_t i = 0; i < landmarks; ++i) {
    of_keypoints.emplace_back(words[i % words.size()]);
  }
  frame->words = std::move(of_keypoints);
  return map.AddKeyframe(frame, Rigid3());
}

// Makes two keyframes covisible.
inline void Connect(Map& map, KeyframeId a, KeyframeId b, int shared = 20) {
  Share(map, {a, b}, shared);
  UpdateCovisibility(map, b);
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "hullslam/map/map.h"

namespace hullslam {

// The order of keyframes in time. Ids of frames give it, ids of keyframes do not: late masks can
// make a keyframe of a frame that is earlier than those of older keyframes (LateDetections).

// The frame that a keyframe was made of. The keyframe may be culled.
FrameId FrameIdOf(const Map& map, KeyframeId keyframe);

// The last keyframe of an island whose frame is before `frame` (step -1), or the first one whose
// frame is after it (step 1). Null if there is none.
const Keyframe* NextInTime(const Map& map, FrameId frame, IslandId island, int step);

// How old a keyframe is when `current` has been added: the number of keyframes up to `current` that
// were made after it and of later frames, culled ones included. Stops counting at `most`.
uint32_t AgeOf(const Map& map, KeyframeId keyframe, KeyframeId current, uint32_t most);

// The keyframe of the latest frame among the observers of a landmark or an object, which must have
// some.
template <typename ObservationType>
KeyframeId LastObserver(const Map& map, const std::vector<ObservationType>& observations) {
  KeyframeId last = observations.back().keyframe;
  FrameId last_frame = FrameIdOf(map, last);
  for (const ObservationType& observation : observations) {
    const FrameId frame = FrameIdOf(map, observation.keyframe);
    if (last_frame < frame) {
      last = observation.keyframe;
      last_frame = frame;
    }
  }
  return last;
}

}  // namespace hullslam

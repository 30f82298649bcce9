// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/keyframe_order.h"

namespace hullslam {

FrameId FrameIdOf(const Map& map, KeyframeId id) {
  const Keyframe* const keyframe = map.keyframes().Find(id);
  return keyframe != nullptr ? keyframe->frame->id : map.culled().At(id).frame;
}

const Keyframe* NextInTime(const Map& map, FrameId frame, IslandId island, int step) {
  const CowTable<FrameId, KeyframeId>& keyframes = map.keyframes_by_frame();
  do {
    frame = step > 0 ? keyframes.After(frame) : keyframes.Before(frame);
    const Keyframe* const keyframe =
        frame.IsValid() ? map.keyframes().Find(keyframes.At(frame)) : nullptr;
    if (keyframe != nullptr && keyframe->island == island) {
      return keyframe;
    }
  } while (frame.IsValid());
  return nullptr;
}

uint32_t AgeOf(const Map& map, KeyframeId id, KeyframeId current, uint32_t most) {
  const FrameId frame = FrameIdOf(map, id);
  uint32_t age = 0;
  for (uint32_t i = id.value + 1; i <= current.value && age < most; ++i) {
    age += frame < FrameIdOf(map, KeyframeId(i)) ? 1 : 0;
  }
  return age;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/contradicted_object.h"

#include "map/keyframe_order.h"
#include "objects/visibility.h"

namespace hullslam {

bool IsContradicted(const Map& map, const Sensor& sensor, KeyframeId current, ObjectId id,
                    const ChangeOptions& options, Contradictions<ObjectId>& contradictions) {
  const Keyframe& keyframe = map.keyframes().At(current);
  const ObjectLandmark& object = map.objects().At(id);
  const FrameId last_seen = FrameIdOf(map, LastObserver(map, object.observations));
  return last_seen < keyframe.frame->id &&
         SeesThrough(sensor, *keyframe.frame, keyframe.cam_from_world, object.ellipsoid,
                     options.min_seen_through) &&
         contradictions.Add(id, last_seen) >= options.min_keyframes;
}

}  // namespace hullslam

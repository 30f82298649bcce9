// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/latest_views.h"

#include <algorithm>

namespace hullslam {

std::vector<ObjectView> LatestViews(const Map& map, const ObjectLandmark& object, size_t count) {
  const size_t total = object.observations.size();
  std::vector<ObjectView> views;
  views.reserve(std::min(count, total));
  for (size_t i = total - std::min(count, total); i < total; ++i) {
    const ObjectObservation& observation = object.observations[i];
    const Keyframe& keyframe = map.keyframes().At(observation.keyframe);
    views.push_back({observation.keyframe, keyframe.cam_from_world,
                     &keyframe.frame->detections[observation.detection]});
  }
  return views;
}

}  // namespace hullslam

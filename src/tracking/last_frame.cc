// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/last_frame.h"

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// Replaces each landmark by the one that has replaced it. If two of them have become one, only the
// first keypoint keeps it: a frame observes a landmark at one keypoint.
void ResolveAll(const Map& map, std::vector<LandmarkId>& landmarks) {
  std::vector<bool> is_taken(map.landmarks().NextId().value, false);
  for (LandmarkId& landmark : landmarks) {
    landmark = map.Resolve(landmark);
    if (!landmark.IsValid()) {
      continue;
    }
    if (is_taken[landmark.value]) {
      landmark = LandmarkId();
    } else {
      is_taken[landmark.value] = true;
    }
  }
}

}  // namespace

LastFrame FollowMap(const Map& map, LastFrame last) {
  if (last.pose && last.velocity) {
    last.velocity->translation *= map.ScaleOf(last.pose->reference) / last.pose->reference_scale;
  }
  const std::optional<KeyframeId> keyframe = map.KeyframeOfFrame(last.frame->id);
  if (keyframe && map.keyframes().Contains(*keyframe)) {
    last.landmarks = map.keyframes().At(*keyframe).landmarks;
    last.reference = *keyframe;
    last.pose = RelativePose{*keyframe, Rigid3(), map.ScaleOf(*keyframe)};
  }
  Check(last.pose.has_value(), "the map does not know the last frame");
  last.reference = map.NearestAlive(last.reference);
  ResolveAll(map, last.landmarks);
  last.cam_from_world = map.CamFromWorld(*last.pose);
  return last;
}

}  // namespace hullslam

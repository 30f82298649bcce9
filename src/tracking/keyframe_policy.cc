// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/keyframe_policy.h"

#include "tracking/comparison/orb_slam2_keyframe_rule.h"

namespace hullslam {

bool KeyframePolicy::NeedsKeyframe(const KeyframeEvidence& evidence) const {
  if (rule == KeyframeRule::kOrbSlam2) {
    return NeedsKeyframeByOrbSlam2(evidence, *this);
  }
  if (evidence.requests_waiting >= max_requests_waiting || evidence.inliers < min_landmarks) {
    return false;
  }
  const double time = evidence.time_since_keyframe + time_tolerance;
  const bool is_abrupt = evidence.inliers < abrupt_ratio * evidence.reference_landmarks &&
                         evidence.confirmed_inliers >= min_confirmed;
  if (time < min_time_between && !is_abrupt) {
    return false;
  }
  const bool lacks_close_points =
      evidence.close_tracked < min_close_tracked && evidence.close_untracked > max_close_untracked;
  const double ratio = evidence.keyframes < 2 ? young_reference_ratio : min_reference_ratio;
  const bool is_leaving = evidence.next_overlap < min_next_overlap;
  const bool is_weak =
      !evidence.is_known_view && !evidence.is_well_mapped &&
      (is_leaving || lacks_close_points || evidence.inliers < ratio * evidence.reference_landmarks);
  const bool lacks_objects =
      evidence.unknown_objects > 0 && time >= objects.TimeAfter(evidence.fruitless_requests);
  const bool seeks_join = evidence.has_islands && time >= time_for_joins;
  const bool is_overdue = time >= max_time_between;
  const bool is_urgent = is_overdue || is_abrupt || is_leaving || lacks_close_points;
  return (is_weak || lacks_objects || seeks_join) && (evidence.mapper_is_idle || is_urgent);
}

bool KeyframePolicy::NeedsKeyframeForObjects(KeyframeEvidence evidence) const {
  const bool is_needed = NeedsKeyframe(evidence);
  evidence.unknown_objects = 0;
  return is_needed && !NeedsKeyframe(evidence);
}

bool KeyframePolicy::NeedsKeyframeForJoin(KeyframeEvidence evidence) const {
  const bool is_needed = NeedsKeyframe(evidence);
  evidence.has_islands = false;
  return is_needed && !NeedsKeyframe(evidence);
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

namespace hullslam {

// What the decision for a new keyframe rests on.
struct KeyframeEvidence {
  uint32_t frames_since_keyframe = 0;
  int inliers = 0;              // landmarks found in the frame
  int reference_landmarks = 0;  // of the reference keyframe, held well enough
  int close_tracked = 0;        // close keypoints (with precise depth) that are landmarks
  int close_untracked = 0;      // and that are not
  int unknown_objects = 0;      // detections that show no mapped object
  size_t keyframes = 0;
  bool mapper_is_idle = true;
  int requests_waiting = 0;
};

struct KeyframePolicy {
  uint32_t min_frames_between = 6;     // but when tracking has weakened abruptly
  uint32_t max_frames_between = 30;    // then a busy mapper is no excuse
  uint32_t frames_for_objects = 10;    // after so many an object that is not mapped is a reason
  double min_reference_ratio = 0.9;    // of inliers to reference landmarks
  double young_reference_ratio = 0.4;  // the same while there is a single keyframe
  double abrupt_ratio = 0.5;           // below it at once, whatever was before
  int min_close_tracked = 100;
  int max_close_untracked = 70;
  int max_requests_waiting = 3;

  // As in Mur-Artal and Tardos 2017, section III.E: tracking has weakened against the reference
  // keyframe, or close points would be lost; and the mapper has time, or it is urgent. Unlike there
  // keyframes are evenly spread in time: fewer landmarks are enough of a reason, but not right
  // after the last keyframe (docs/decisions.md). Objects are mapped from keyframes: those that are
  // not yet are another reason, less urgent.
  bool NeedsKeyframe(const KeyframeEvidence& evidence) const;
};

}  // namespace hullslam

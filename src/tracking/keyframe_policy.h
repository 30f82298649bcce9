// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

namespace hullslam {

// What the decision for a new keyframe is based on.
struct KeyframeEvidence {
  uint32_t frames_since_keyframe = 0;
  int inliers = 0;              // landmarks found in the frame
  int reference_landmarks = 0;  // of the reference keyframe, with enough observations
  int close_tracked = 0;        // close keypoints (with precise depth) that show a landmark
  int close_untracked = 0;      // close keypoints that do not
  int unknown_objects = 0;      // detections that show no mapped object
  size_t keyframes = 0;
  bool mapper_is_idle = true;
  int requests_waiting = 0;
};

struct KeyframePolicy {
  uint32_t min_frames_between = 6;     // unless tracking has weakened abruptly
  uint32_t max_frames_between = 30;    // after so many, also if the mapper is busy
  uint32_t frames_for_objects = 10;    // after so many, also for objects that are not mapped
  double min_reference_ratio = 0.9;    // of inliers to reference landmarks
  double young_reference_ratio = 0.4;  // the same while the map has a single keyframe
  double abrupt_ratio = 0.5;           // below it at once, however recent the last keyframe is
  int min_close_tracked = 100;
  int max_close_untracked = 70;
  int max_requests_waiting = 3;

  // A keyframe is needed if the frame finds too few landmarks of the reference keyframe or close
  // points would be lost, and the mapper is idle or it is urgent (Mur-Artal and Tardos 2017,
  // section III.E). Two things differ from the paper. Keyframes are spread evenly in time: a
  // smaller loss of landmarks is enough, but there is a least time between keyframes
  // (docs/decisions.md). Objects that are not mapped yet are another, less urgent reason, because
  // objects are mapped from keyframes.
  bool NeedsKeyframe(const KeyframeEvidence& evidence) const;
};

}  // namespace hullslam

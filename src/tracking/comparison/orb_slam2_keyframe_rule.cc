// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/comparison/orb_slam2_keyframe_rule.h"

namespace hullslam {
namespace {

constexpr double kRatio = 0.75;
constexpr double kRatioOfSecondKeyframe = 0.4;
constexpr double kRatioWithoutDepth = 0.9;
constexpr double kUrgentRatio = 0.25;
// mMaxFrames of the released code is the frame rate, so it stands for this time, s.
constexpr double kLongestTime = 1.0;

double ReferenceRatio(const KeyframeEvidence& evidence, const KeyframePolicy& policy) {
  if (!policy.has_depth) {
    return kRatioWithoutDepth;
  }
  return evidence.keyframes < 2 ? kRatioOfSecondKeyframe : kRatio;
}

}  // namespace

bool NeedsKeyframeByOrbSlam2(const KeyframeEvidence& evidence, const KeyframePolicy& policy) {
  const double keyframes = static_cast<double>(evidence.keyframes);
  const double frames_in_time = kLongestTime / (2.0 * policy.time_tolerance);
  const bool was_lost =
      evidence.time_since_relocalisation &&
      kLongestTime > *evidence.time_since_relocalisation + policy.time_tolerance &&
      keyframes > frames_in_time;
  if (was_lost || evidence.inliers <= policy.min_landmarks) {
    return false;
  }
  const double time = evidence.time_since_keyframe + policy.time_tolerance;
  const bool lacks_close_points = policy.has_depth &&
                                  evidence.close_tracked < policy.min_close_tracked &&
                                  evidence.close_untracked > policy.max_close_untracked;
  const bool is_idle = evidence.mapper_is_idle && time >= policy.min_time_between;
  const bool is_urgent =
      policy.has_depth &&
      (evidence.inliers < kUrgentRatio * evidence.reference_landmarks || lacks_close_points);
  const bool is_weak =
      evidence.inliers < ReferenceRatio(evidence, policy) * evidence.reference_landmarks;
  const bool is_due =
      (is_idle || time >= kLongestTime || is_urgent) && (is_weak || lacks_close_points);
  if (!is_due || is_idle) {
    return is_due;
  }
  return policy.has_depth && evidence.requests_waiting < policy.max_requests_waiting;
}

}  // namespace hullslam

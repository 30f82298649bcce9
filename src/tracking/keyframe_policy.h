// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "hullslam/tracking/tracking_options.h"
#include "objects/request_memory.h"

namespace hullslam {

// The facts on which the decision for a new keyframe is based.
struct KeyframeEvidence {
  double time_since_keyframe = 0.0;  // s
  int inliers = 0;                   // landmarks found in the frame
  int confirmed_inliers = 0;         // those of them with enough observations
  int reference_landmarks = 0;       // landmarks of the reference keyframe with enough observations
  int close_tracked = 0;             // close keypoints (with precise depth) that show a landmark
  int close_untracked = 0;           // close keypoints that show no landmark
  int unknown_objects = 0;           // detections that show no mapped object
  int fruitless_requests =
      0;  // keyframes requested for objects alone since an object was last mapped
  double next_overlap = 1.0;    // share of the reference's view in the next image (NextOverlap)
  bool is_known_view = false;   // another keyframe shows the same (IsKnownView)
  bool is_well_mapped = false;  // the map is mature here (IsWellMapped)
  size_t keyframes = 0;
  // Parts of the map are not joined to one another, and the frame may help to join them
  // (JoinRequests).
  bool has_islands = false;
  // s; absent if the camera was not relocalised.
  std::optional<double> time_since_relocalisation = std::nullopt;
  bool mapper_is_idle = true;
  int requests_waiting = 0;
};

struct KeyframePolicy {
  KeyframeRule rule = KeyframeRule::kHullslam;
  bool has_depth = true;
  int min_landmarks = 15;         // a frame with fewer would be a keyframe without connections
  double min_time_between = 0.2;  // s, unless tracking has weakened abruptly
  double max_time_between = 1.0;  // s; after this time, also if the mapper is busy
  ObjectRequestRule objects;      // after its time, also for objects that are not mapped
  // s; after this time, also if there are islands, because only keyframes are compared with earlier
  // places, and a join needs two of them that show the same one.
  double time_for_joins = 1.0 / 3.0;
  // s. A time limit counts as reached up to this much earlier. It is half the time between two
  // frames, because time stamps are not exactly regular.
  double time_tolerance = 1.0 / 60.0;
  double min_reference_ratio = 0.9;    // least ratio of inliers to reference landmarks
  double young_reference_ratio = 0.4;  // the same while the map has a single keyframe
  double abrupt_ratio = 0.5;           // below this ratio a keyframe is requested at once
  // So many landmarks with enough observations are needed for this. Without depth it is the number
  // that a tracked frame needs, with depth it is 0.
  int min_confirmed = 0;
  // A frame is needed as a keyframe if the next one could show less than this share of the
  // reference keyframe's view: then each frame shares half of what it shows with a keyframe.
  double min_next_overlap = 0.5;
  int min_close_tracked = 100;
  int max_close_untracked = 70;
  int max_requests_waiting = 3;

  // Whether a keyframe is needed by the rule of the policy. That of ORB-SLAM2 is explained in
  // orb_slam2_keyframe_rule.h, the other one here.
  //
  // A keyframe is needed under two conditions (Mur-Artal and Tardos 2017, section III.E). The frame
  // finds too few landmarks of the reference keyframe, or close points would be lost; and the
  // mapper is idle, or the need is urgent. Two things differ from the paper. Keyframes are spread
  // evenly in time: a smaller loss of landmarks is enough, but there is a least time between
  // keyframes (docs/decisions.md). Objects that are not mapped yet are another, less
  // urgent reason, because objects are mapped from keyframes. If images are far apart, as in
  // recordings of one image a second, the next one may leave the view of the reference keyframe
  // although this one still finds many of its landmarks; so the expected overlap counts too.
  //
  // Without depth, an abrupt loss of landmarks gives a keyframe before its time only if the frame
  // would be tracked without the landmarks that just two keyframes observe. Nothing but the two
  // poses says how far away those are: a match that slid along an edge fits the two views as well
  // as the right one. A pose that needs them agrees with them even if it is wrong, and keyframes
  // in a row, each of which is held by the landmarks of the one before, would drift away unnoticed.
  //
  // Where another keyframe shows the same, tracking counts as strong: the frame finds fewer
  // landmarks than the reference keyframe has because keypoints differ from image to image, and a
  // new keyframe would only double them. So a camera that stays in a place adds no keyframes. Where
  // the map is mature, unknown objects are those that LastingChanges tells.
  //
  // A frame with fewer than `min_landmarks` landmarks is never a keyframe, even if objects give its
  // pose. Covisibility and bundle adjustment could not connect it with the others, and its new
  // landmarks would be second copies of landmarks that the map already has.
  bool NeedsKeyframe(const KeyframeEvidence& evidence) const;
  // Whether a keyframe is needed only because of objects, or only to join parts of the map.
  bool NeedsKeyframeForObjects(KeyframeEvidence evidence) const;
  bool NeedsKeyframeForJoin(KeyframeEvidence evidence) const;
};

}  // namespace hullslam

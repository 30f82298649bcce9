// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tracking/keyframe_policy.h"

namespace hullslam {

// Whether ORB-SLAM2 would make the frame a keyframe (Mur-Artal and Tardos 2017, section III.E, and
// the function NeedNewKeyFrame of the released Tracking.cc). The frame must have
//   more than `policy.min_landmarks` landmarks; and
//   less than 0.75 of the reference keyframe's landmarks (0.4 while there is one keyframe, 0.9
//   without depth), or a lack of close points.
// In addition one of these must hold: the mapper is idle; a second has passed; or, with depth, a
// quarter of the landmarks is not found or close points lack. A busy mapper takes the frame only
// with depth, and if fewer than three wait. No keyframe is made within a second of a
// relocalisation, unless the map has no more keyframes than the camera takes frames in that time.
//
// In the sequential pipeline the mapper is always idle. There `policy.min_time_between` stands for
// the time in which ORB-SLAM2's mapper works on the last keyframe.
bool NeedsKeyframeByOrbSlam2(const KeyframeEvidence& evidence, const KeyframePolicy& policy);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "tracking/pose_refinement.h"

namespace hullslam {

// Whether a keyframe of this session that is more than 30 s older shows what the frame shows from
// almost the same place, so that another keyframe would double its landmarks. It is one of those
// that are covisible with `reference`; the frame finds enough of its landmarks, and most of what
// the frame finds would be almost where the frame shows it, at almost the same distance. A camera
// that goes to and fro thus makes no keyframe where it has been before. A later session looks at
// all places anew, because things may have changed.
bool IsKnownView(const Map& map, const Sensor& sensor, const Frame& frame, FrameId first_of_session,
                 KeyframeId reference, const PoseEstimate& estimate);

}  // namespace hullslam

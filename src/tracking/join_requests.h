// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/keyframe.h"
#include "hullslam/map/map.h"
#include "tracking/pose_refinement.h"

namespace hullslam {

// Remembers the keyframes that were requested only to join parts of the map, and what the camera
// saw then. Place recognition compares each of them with the other parts. A few keyframes of one
// view suffice to recognise a place. More of them would be compared in vain, and a camera that
// stands still would add keyframes for ever.
class JoinRequests {
 public:
  // Whether a frame with this pose may still be requested: the last keyframes were requested in
  // another view, or there were few of them. `estimate` has the landmarks of the frame.
  bool MayAskAgain(const Map& map, const Sensor& sensor, KeyframeId reference,
                   const PoseEstimate& estimate);
  void Add(const Map& map, KeyframeId reference, const PoseEstimate& estimate);

 private:
  bool IsSameView(const Map& map, const Sensor& sensor, KeyframeId reference,
                  const PoseEstimate& estimate) const;

  int requests_ = 0;  // in the view
  // The first frame in the view: its pose, and the landmarks that it showed.
  RelativePose pose_;
  std::vector<LandmarkId> landmarks_;
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "tracking/pose_refinement.h"
#include "util/id_set.h"

namespace hullslam {

// The covariances of poses (TrackedFrame::covariance). A frame is measured against its landmarks
// with the covariance P = information^-1. The landmarks that a keyframe created share the error of
// its pose, which does not average out. So the covariance of a frame is P + the mean of D over the
// keyframes that created its landmarks, and D of a keyframe is the covariance of its frame; 0 for
// those that the map began with. D grows where the camera enters a new place, and is small again
// where it returns. The drift of a monocular map's scale is not part of it.
class DriftModel {
 public:
  // The covariance of the pose, in the axes of the camera (Retract).
  Eigen::Matrix<double, 6, 6> Covariance(const Map& map, const PoseEstimate& estimate) const;
  // Notes the covariance of a frame that is to become a keyframe.
  void Add(FrameId keyframe, const Rigid3& cam_from_world,
           const Eigen::Matrix<double, 6, 6>& covariance);

 private:
  struct Drift {
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  };
  IdMap<FrameId, Drift> drifts_;  // D, in the axes of the world
};

}  // namespace hullslam

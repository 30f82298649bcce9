// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/map/map.h"
#include "tracking/pose_refinement.h"
#include "util/id_set.h"

namespace hullslam {

// The covariances of poses (TrackedFrame::covariance). A frame is measured against its landmarks
// with the covariance H^-1 if their errors are independent. Neighbours share errors, so all frames
// so far determine a factor f (PoseEstimate::squares); at least 1, since H leaves errors of the map
// out. The landmarks that a keyframe created share the error of its pose, which does not average
// out. So the covariance of a frame is P = f H^-1 + the mean of D over the keyframes that created
// its landmarks, and D of a keyframe is the covariance of its frame; 0 for those that the map began
// with. D grows where the camera enters a new place, and is small again where it returns. The drift
// of a monocular map's scale is not part of it.
//
// A prior, from the last frame with its P = L by a motion with the covariance Q, has the weight B
// in the fused pose. Both frames show the same landmarks, so their errors are taken for the same:
// P = R R' + B Q B', R = (I - B) sqrt(f H^-1) + B sqrt(L). Fusing takes nothing of them away.
class DriftModel {
 public:
  // P of the next frame, in the axes of the camera (Retract).
  Eigen::Matrix<double, 6, 6> Measured(const PoseEstimate& estimate);
  // The mean of D, in the same axes.
  Eigen::Matrix<double, 6, 6> Drift(const Map& map, const PoseEstimate& estimate) const;
  // Notes the covariance of a frame that is to become a keyframe.
  void Add(FrameId keyframe, const Rigid3& cam_from_world,
           const Eigen::Matrix<double, 6, 6>& covariance);

 private:
  struct OfKeyframe {
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  };
  IdMap<FrameId, OfKeyframe> drifts_;  // D, in the axes of the world
  double squares_ = 0.0;
  double expected_squares_ = 0.0;
};

}  // namespace hullslam

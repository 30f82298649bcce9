// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/drift_model.h"

#include <Eigen/LU>

namespace hullslam {
namespace {

// The frame of a keyframe that the map has or has culled; invalid if it has forgotten it.
FrameId FrameOf(const Map& map, KeyframeId id) {
  if (const Keyframe* const keyframe = map.keyframes().Find(id)) {
    return keyframe->frame->id;
  }
  const CulledKeyframe* const culled = map.FindCulled(id);
  return culled != nullptr ? culled->frame : FrameId();
}

}  // namespace

Eigen::Matrix<double, 6, 6> DriftModel::Covariance(const Map& map,
                                                   const PoseEstimate& estimate) const {
  IdMap<KeyframeId, int> created;
  int all = 0;
  for (const LandmarkId id : estimate.landmarks) {
    if (id.IsValid()) {
      ++created[map.landmarks().At(id).created_by];
      ++all;
    }
  }
  Eigen::Matrix<double, 6, 6> drift = Eigen::Matrix<double, 6, 6>::Zero();
  for (const auto& [keyframe, count] : created.entries()) {
    if (const Drift* const of_keyframe = drifts_.Find(FrameOf(map, keyframe))) {
      drift += static_cast<double>(count) / all * of_keyframe->covariance;
    }
  }
  return estimate.information.inverse() + InAxesOf(estimate.cam_from_world, drift);
}

void DriftModel::Add(FrameId keyframe, const Rigid3& cam_from_world,
                     const Eigen::Matrix<double, 6, 6>& covariance) {
  drifts_[keyframe].covariance = InAxesOf(Inverse(cam_from_world), covariance);
}

}  // namespace hullslam

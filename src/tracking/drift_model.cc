// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/drift_model.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace hullslam {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

Matrix6d Root(const Matrix6d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> parts(covariance);
  return parts.eigenvectors() * parts.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         parts.eigenvectors().transpose();
}

// The frame of a keyframe that the map has or has culled; invalid if it has forgotten it.
FrameId FrameOf(const Map& map, KeyframeId id) {
  if (const Keyframe* const keyframe = map.keyframes().Find(id)) {
    return keyframe->frame->id;
  }
  const CulledKeyframe* const culled = map.FindCulled(id);
  return culled != nullptr ? culled->frame : FrameId();
}

}  // namespace

Matrix6d DriftModel::Measured(const PoseEstimate& estimate) {
  squares_ += estimate.squares;
  expected_squares_ += estimate.expected_squares;
  const double factor = squares_ > expected_squares_ ? squares_ / expected_squares_ : 1.0;
  const Matrix6d of_landmarks = factor * estimate.seen_information.inverse();
  const Matrix6d of_motion =
      Matrix6d::Identity() - estimate.information.llt().solve(estimate.seen_information);
  const Matrix6d root = (Matrix6d::Identity() - of_motion) * Root(of_landmarks) +
                        of_motion * Root(estimate.last_covariance);
  return root * root.transpose() + of_motion * estimate.motion_covariance * of_motion.transpose();
}

Matrix6d DriftModel::Drift(const Map& map, const PoseEstimate& estimate) const {
  IdMap<KeyframeId, int> created;
  int all = 0;
  for (const LandmarkId id : estimate.landmarks) {
    if (id.IsValid()) {
      ++created[map.landmarks().At(id).created_by];
      ++all;
    }
  }
  Matrix6d drift = Matrix6d::Zero();
  for (const auto& [keyframe, count] : created.entries()) {
    if (const OfKeyframe* const of_keyframe = drifts_.Find(FrameOf(map, keyframe))) {
      drift += static_cast<double>(count) / all * of_keyframe->covariance;
    }
  }
  return InAxesOf(estimate.cam_from_world, drift);
}

void DriftModel::Add(FrameId keyframe, const Rigid3& cam_from_world, const Matrix6d& covariance) {
  drifts_[keyframe].covariance = InAxesOf(Inverse(cam_from_world), covariance);
}

}  // namespace hullslam

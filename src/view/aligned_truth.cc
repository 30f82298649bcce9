// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/aligned_truth.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "hullslam/eval/ate.h"

namespace hullslam {

std::string AddGroundtruth(const Trajectory& groundtruth, AlignmentKind alignment,
                           ViewModel& model) {
  const AteReport report = EvaluateAte(groundtruth, model.trajectory, {.alignment = alignment});
  if (!report.ok()) {
    return report.failure;
  }
  const PointAlignment& truth_from_map = report.reference_from_estimate;
  const Rigid3 map_from_truth = Inverse(truth_from_map.target_from_source);
  for (const StampedPose& pose : groundtruth) {
    Rigid3 moved = map_from_truth * pose.world_from_cam;
    moved.translation /= truth_from_map.scale;
    model.groundtruth.push_back({pose.timestamp, moved});
  }
  for (const auto& [truth, estimate] : PairPoses(groundtruth, model.trajectory, PairingRule::kTum,
                                                 DefaultMaxDifference(PairingRule::kTum))) {
    const StampedPose& pose = model.trajectory[estimate];
    model.errors.timestamps.push_back(pose.timestamp);
    model.errors.metres.push_back((groundtruth[truth].world_from_cam.translation -
                                   truth_from_map * pose.world_from_cam.translation)
                                      .norm());
  }
  const Eigen::Matrix3d rotation = truth_from_map.target_from_source.rotation.toRotationMatrix();
  if (alignment != AlignmentKind::kNone) {
    model.up = FindUp(model.trajectory, &rotation);
  }
  return {};
}

std::optional<Eigen::Vector3d> FindUp(const Trajectory& poses,
                                      const Eigen::Matrix3d* truth_from_map) {
  constexpr double kLeastMean = 0.2;  // length of the mean of the unit vectors
  const double nearest = std::cos(40.0 / 180.0 * std::numbers::pi);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : poses) {
    sum -= pose.world_from_cam.rotation * Eigen::Vector3d::UnitY();
  }
  if (poses.empty() || sum.norm() < kLeastMean * static_cast<double>(poses.size())) {
    return std::nullopt;
  }
  const Eigen::Vector3d up = sum.normalized();
  if (truth_from_map == nullptr) {
    return up;
  }
  const Eigen::Vector3d in_truth = *truth_from_map * up;
  Eigen::Index axis = 0;
  if (in_truth.cwiseAbs().maxCoeff(&axis) < nearest) {
    return up;
  }
  return std::copysign(1.0, in_truth[axis]) * truth_from_map->row(axis).transpose().normalized();
}

}  // namespace hullslam

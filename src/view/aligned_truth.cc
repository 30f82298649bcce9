// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/aligned_truth.h"

#include <vector>

#include "hullslam/eval/ate.h"
#include "scene/up_direction.h"

namespace hullslam {

std::string AddGroundtruth(const Trajectory& groundtruth, AlignmentKind alignment,
                           ViewModel& model) {
  const AteResult report = EvaluateAte(groundtruth, model.trajectory, {.alignment = alignment});
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
  return {};
}

void AddUp(const std::optional<Trajectory>& groundtruth, ViewModel& model) {
  std::vector<Eigen::Vector3d> landmarks;
  landmarks.reserve(model.landmarks.positions.size());
  for (const Eigen::Vector3f& position : model.landmarks.positions) {
    landmarks.push_back(position.cast<double>());
  }
  model.up = FindUp(groundtruth, model.trajectory, landmarks).up;
  if (!model.up) {
    model.up = UpFromImages(model.trajectory);
  }
}

}  // namespace hullslam

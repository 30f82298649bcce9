// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/truth_evaluation.h"

#include <cmath>
#include <utility>

namespace hullslam {
namespace {

// The factor that converts errors of orientation (radians) to errors of position (m): the mean
// distance of the mapped objects from the keyframes that observe them. 1 if no object is mapped.
// `scale` is the length of one unit of the map in metres.
double MeanDistance(const ObjectResults& report, double scale) {
  double sum = 0.0;
  size_t count = 0;
  for (const ObjectResult& object : report.objects) {
    if (object.state == ObjectState::kMapped) {
      for (const ObservationResult& view : object.observations) {
        sum += (view.cam_from_world * object.ellipsoid.world_from_object.translation).norm();
        ++count;
      }
    }
  }
  return sum > 0.0 ? scale * sum / static_cast<double>(count) : 1.0;
}

std::vector<SeenBox> BoxesOf(const std::vector<InstanceMask>& masks, const PinholeCamera& camera) {
  std::vector<SeenBox> boxes;
  for (const InstanceMask& mask : masks) {
    SeenBox seen{mask.label, {}};
    for (const std::vector<Eigen::Vector2d>& outline : mask.outlines) {
      for (const Eigen::Vector2d& point : outline) {
        seen.box.extend(camera.Undistort(point));
      }
    }
    boxes.push_back(seen);
  }
  return boxes;
}

}  // namespace

Sim3 AlignWorlds(const AlignedPoses& poses, const ObjectResults& report) {
  const double scale = poses.ate.reference_from_estimate.scale;
  std::vector<Rigid3> truths;
  std::vector<Rigid3> estimates;
  for (const auto& [truth, estimate] : PairPoses(poses.groundtruth, poses.run, PairingRule::kTum,
                                                 DefaultMaxDifference(PairingRule::kTum))) {
    truths.push_back(poses.groundtruth[truth].world_from_cam);
    estimates.push_back(poses.run[estimate].world_from_cam);
    estimates.back().translation *= scale;
  }
  const Rigid3 truth_from_scaled = AlignPoses(estimates, truths, MeanDistance(report, scale));
  return {scale, truth_from_scaled.rotation, truth_from_scaled.translation};
}

TruthEvaluation EvaluateTruth(const TrueScene& scene, const AlignedPoses& poses,
                              const ObjectResults& report, std::vector<size_t> sightings,
                              size_t min_masks) {
  TruthEvaluation evaluation;
  evaluation.truths = scene.objects;
  evaluation.sightings = std::move(sightings);
  evaluation.alignment = poses.alignment;
  evaluation.scale = poses.ate.reference_from_estimate.scale;
  const Sim3 truth_from_map = AlignWorlds(poses, report);
  evaluation.comparison = CompareWithTruth(evaluation.truths, report, truth_from_map);
  if (report.changes && scene.is_rearranged) {
    evaluation.changes =
        CompareChanges(scene, *report.changes, truth_from_map, evaluation.sightings, min_masks);
  }
  evaluation.counts =
      CountMapped(evaluation.truths, evaluation.comparison, evaluation.sightings, min_masks);
  evaluation.ate_rmse_m = poses.ate.errors.rmse;
  evaluation.min_masks = min_masks;
  return evaluation;
}

std::vector<size_t> CountAllSightings(
    const std::vector<TrueObject>& truths, const PinholeCamera& camera,
    const Trajectory& groundtruth, const Trajectory& run, std::span<const double> stamps,
    const std::function<std::vector<InstanceMask>(size_t frame)>& read) {
  std::vector<double> true_stamps;
  for (const StampedPose& pose : groundtruth) {
    true_stamps.push_back(pose.timestamp);
  }
  std::vector<size_t> sightings(truths.size(), 0);
  for (size_t i = 0; i < stamps.size(); ++i) {
    const size_t nearest = NearestStamp(true_stamps, stamps[i]);
    const bool during = stamps[i] >= run.front().timestamp && stamps[i] <= run.back().timestamp;
    if (during &&
        std::abs(true_stamps[nearest] - stamps[i]) <= DefaultMaxDifference(PairingRule::kTum)) {
      CountSightings(truths, camera, Inverse(groundtruth[nearest].world_from_cam),
                     BoxesOf(read(i), camera), sightings);
    }
  }
  return sightings;
}

}  // namespace hullslam

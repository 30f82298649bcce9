// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "eval/object_groundtruth.h"
#include "hullslam/eval/ate.h"
#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// The objects of a run compared with the true objects of the synthetic sequence.
struct TruthEvaluation {
  std::vector<TrueObject> truths;
  std::vector<size_t> sightings;  // masks of each true object; empty if the sequence has no masks
  GroundtruthComparison comparison;
  TruthCounts counts;
  std::optional<ChangeComparison>
      changes;  // only of a run that went on with a map from before the rearrangement
  AlignmentKind alignment = AlignmentKind::kSe3;  // kSe3 or kSim3
  double scale = 1.0;                             // metres per unit of the map
  double ate_rmse_m = 0.0;                        // ATE of the run, aligned by positions
  size_t min_masks = 0;
};

// The poses of a run and the true ones, aligned by their positions.
struct AlignedPoses {
  const Trajectory& groundtruth;
  const Trajectory& run;
  const AteResult& ate;  // of these two; ok()
  AlignmentKind alignment;
};

// The transform from the world of the run to the true world. The scale comes from the alignment by
// positions. The orientations are used too, because the positions do not determine the rotation of
// the world if the camera hardly moved: an error of orientation (radians) counts as much as an
// error of position (m) at the mean distance of the mapped objects from the keyframes that observe
// them.
Sim3 AlignWorlds(const AlignedPoses& poses, const ObjectResults& report);

// Compares the mapped objects of a report with the true objects. `sightings` counts the masks of
// each true object during the run (CountSightings()); empty if the sequence has no masks.
TruthEvaluation EvaluateTruth(const TrueScene& scene, const AlignedPoses& poses,
                              const ObjectResults& report, std::vector<size_t> sightings,
                              size_t min_masks);

// For each true object, the number of masks that show it in the frames of a run. `stamps` are those
// of the frames of the sequence, s, and `read` gives the masks of one of them.
std::vector<size_t> CountAllSightings(
    const std::vector<TrueObject>& truths, const PinholeCamera& camera,
    const Trajectory& groundtruth, const Trajectory& run, std::span<const double> stamps,
    const std::function<std::vector<InstanceMask>(size_t frame)>& read);

}  // namespace hullslam

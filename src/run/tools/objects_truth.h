// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "eval/change_groundtruth.h"
#include "eval/object_groundtruth.h"
#include "run/tools/objects_command.h"

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

// Reads groundtruth_objects.json, and from the same folder groundtruth.txt and the masks. Throws
// InputError for bad files, and if no pose of the run has a true pose at its time. `alignment` is
// kSe3, or kSim3 if the unit of length of the run is not the metre.
TruthEvaluation EvaluateTruth(const ObjectsArguments& arguments, const ObjectReport& report,
                              AlignmentKind alignment);

void PrintTruth(const TruthEvaluation& evaluation);
nlohmann::ordered_json ToJson(const TruthEvaluation& evaluation);

}  // namespace hullslam

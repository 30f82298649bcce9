// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "evaluate/objects_command.h"
#include "hullslam/eval/object_groundtruth.h"

namespace hullslam {

// The objects of a run beside those of the made-up sequence it was run on.
struct TruthEvaluation {
  std::vector<TrueObject> truths;
  std::vector<size_t> sightings;  // masks of each; empty where the sequence has none
  GroundtruthComparison comparison;
  TruthCounts counts;
  double ate_rmse_m = 0.0;  // of the trajectory that aligns the two worlds
  size_t min_masks = 0;
};

// Reads groundtruth_objects.json, and beside it groundtruth.txt and the masks. Throws InputError
// for bad files, and where run and truth have no poses in common.
TruthEvaluation EvaluateTruth(const ObjectsArguments& arguments, const ObjectReport& report);

void PrintTruth(const TruthEvaluation& evaluation);
nlohmann::ordered_json ToJson(const TruthEvaluation& evaluation);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "eval/truth_evaluation.h"
#include "run/tools/objects_command.h"

namespace hullslam {

// Reads groundtruth_objects.json, and from the same folder groundtruth.txt and the masks. Throws
// InputError for bad files, and if no pose of the run has a true pose at its time. `alignment` is
// kSe3, or kSim3 if the unit of length of the run is not the metre.
TruthEvaluation ReadAndEvaluateTruth(const ObjectsArguments& arguments, const ObjectResults& report,
                                     AlignmentKind alignment);

void PrintTruth(const TruthEvaluation& evaluation);
nlohmann::ordered_json ToJson(const TruthEvaluation& evaluation);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "eval/body_metrics.h"
#include "eval/truth_evaluation.h"
#include "hullslam/eval/rpe.h"
#include "report/object_results.h"

namespace hullslam {

// The reports of `hullslam evaluate`, as JSON (docs/outputs.md) and as text for people.

// The absolute error must be known.
std::string TrajectoryErrorsJson(const TrajectoryErrors& errors);
std::string TrajectoryErrorsText(const TrajectoryErrors& errors);

// How well the objects of a run fit their observations and, if it is known, the truth. In the text,
// lengths are in metres or, if the alignment has a scale, in "u", the unit of length of the map.
std::string EvaluationJson(const ObjectResults& report, const std::optional<TruthEvaluation>& truth,
                           const std::optional<BodyEvaluation>& bodies = std::nullopt);
std::string EvaluationText(const ObjectResults& report, AlignmentKind alignment,
                           const std::optional<TruthEvaluation>& truth,
                           const std::optional<BodyEvaluation>& bodies = std::nullopt);

}  // namespace hullslam

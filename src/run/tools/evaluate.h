// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "eval/truth_evaluation.h"
#include "hullslam/eval/ate.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

struct TrajectoryArguments {
  std::string groundtruth;
  std::string estimate;
  AteOptions ate;
  bool json = false;
};

// `arguments` must outlive the app.
CLI::App* AddTrajectoryCommand(CLI::App& app, TrajectoryArguments& arguments);

// Prints the absolute and relative errors of a trajectory. Throws InputError for bad files, and if
// no two poses of the trajectories can be paired.
void RunTrajectoryCommand(const TrajectoryArguments& arguments);

struct ObjectsArguments {
  std::filesystem::path run;
  std::filesystem::path groundtruth;  // groundtruth_objects.json; empty: none
  // The alignment of the run with the ground truth; absent: that of summary.json.
  std::optional<AlignmentKind> alignment;
  size_t min_masks = 30;  // least number of masks with which a true object counts as visible
  bool json = false;
};

// `arguments` must outlive the app.
CLI::App* AddObjectsCommand(CLI::App& app, ObjectsArguments& arguments);

// Prints how well the objects of a run fit their observations and, with ground truth, how near they
// are to the true objects. Throws InputError for bad files.
void RunObjectsCommand(const ObjectsArguments& arguments);

// Reads groundtruth_objects.json, and from the same folder groundtruth.txt and the masks. Throws
// InputError for bad files, and if no pose of the run has a true pose at its time. `alignment` is
// kSe3, or kSim3 if the unit of length of the run is not the metre.
TruthEvaluation ReadAndEvaluateTruth(const ObjectsArguments& arguments, const ObjectResults& report,
                                     AlignmentKind alignment);

void PrintTruth(const TruthEvaluation& evaluation);

}  // namespace hullslam

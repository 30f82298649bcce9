// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "hullslam/geometry/alignment.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

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

}  // namespace hullslam

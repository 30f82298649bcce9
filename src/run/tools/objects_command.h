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
  // How the run is aligned with the ground truth; absent: as summary.json of the run says.
  std::optional<AlignmentKind> alignment;
  size_t min_masks = 30;  // a true object with fewer masks does not count as visible
  bool json = false;
};

// `arguments` must outlive the app.
CLI::App* AddObjectsCommand(CLI::App& app, ObjectsArguments& arguments);

// Prints how well the objects of a run fit their observations and, with ground truth, how near they
// are to the true objects. Throws InputError for bad files.
void RunObjectsCommand(const ObjectsArguments& arguments);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/sequences/image_sequence.h"
#include "results/finished_run.h"
#include "view/view_model.h"

namespace hullslam {

// The data that a program still has after a run, beside the files in its folder. All may be null.
struct RunMemory {
  const Map* map = nullptr;
  const Sensor* sensor = nullptr;          // needed with `map`
  const ObjectOptions* options = nullptr;  // needed with `map`
  const ImageSequence* sequence = nullptr;
  const ViewSettings* settings = nullptr;
};

// The model of a finished run, from the files in its folder (docs/outputs.md) and from `memory`.
// Parts whose file is missing or broken are left out, and a note of the model says so. Throws
// InputError if there is no summary.json or if it cannot be read.
ViewModel ViewOfRun(const std::filesystem::path& folder, const RunMemory& memory = {});

// Adds the surface that was made of the run, or a note of why it is left out.
void AddSurface(const FinishedRun& run, ViewModel& model);

}  // namespace hullslam

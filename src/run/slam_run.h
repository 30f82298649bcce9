// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/system.h"
#include "live/live_output.h"
#include "results/output_folder.h"
#include "results/summarize_run.h"
#include "run/dataset_arguments.h"
#include "run/run_arguments.h"

namespace hullslam {

// Runs RGB-D or monocular SLAM (SystemOptions::sensor) on a sequence. Writes trajectory.txt,
// keyframes.txt, map.ply, summary.json and more (docs/outputs.md) to the output folder; prints the
// results. Returns the program's exit code. Throws InputError for bad input, before the first frame
// if possible. `notes` are lines about the input, which are printed before the first frame.
int RunSlam(const RunArguments& arguments, LoadedSettings settings, const ImageSequence& sequence,
            std::span<const std::string> notes);

struct SlamRun {
  const RunArguments& arguments;
  const LoadedSettings& settings;
  const ImageSequence& sequence;
  const SequenceMasks& masks;
  const std::optional<Trajectory>& groundtruth;
  System& system;
  LiveOutput& live;
  OutputFolder& output;
  size_t earlier_sessions = 0;  // of the map that the run began with
};

// Writes the results of a finished run to its output folder, and its map, recording and report
// where they are asked for. Prints the results, and why the run failed. Returns the exit code.
int FinishSlam(const SlamRun& run, const RunResult& result);

}  // namespace hullslam

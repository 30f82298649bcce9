// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "hullslam/sequences/image_sequence.h"
#include "run/dataset_arguments.h"
#include "run/run_arguments.h"

namespace hullslam {

// Runs RGB-D or monocular SLAM (SystemOptions::sensor) on a sequence. Writes trajectory.txt,
// keyframes.txt, map.ply and summary.json to the output folder, with masks also the files of the
// objects, and groundtruth.txt if the ground truth of the sequence had to be converted; prints the
// results. Returns the program's exit code. Throws InputError for bad input, before the first frame
// if possible. `notes` are lines about the input, which are printed before the first frame.
int RunSlam(const RunArguments& arguments, LoadedSettings settings, const ImageSequence& sequence,
            std::span<const std::string> notes);

}  // namespace hullslam

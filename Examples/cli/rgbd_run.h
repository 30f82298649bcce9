// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/run_arguments.h"
#include "hullslam/io/tum_sequence.h"

namespace hullslam {

// Runs RGB-D SLAM on a sequence. Writes trajectory.txt, keyframes.txt, map.ply and summary.json to
// the output folder, with masks also objects.json and objects.ply, and prints the results. Returns
// the program's exit code. Throws InputError for bad input, before the first frame if possible.
int RunRgbd(const RunArguments& arguments, const TumSequence& sequence);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/run_arguments.h"
#include "hullslam/io/tum_sequence.h"

namespace hullslam {

// Runs RGB-D SLAM on a sequence, writes trajectory.txt, keyframes.txt, map.ply and summary.json to
// the output folder and prints the results. Returns the program's exit code; throws InputError for
// bad input, before the first frame wherever that can be told.
int RunRgbd(const RunArguments& arguments, const TumSequence& sequence);

}  // namespace hullslam

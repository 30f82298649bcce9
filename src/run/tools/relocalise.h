// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program relocalise.
// Measures how well single frames are found in a map of other frames of the same sequence. Parses
// the command line and returns the exit code. Throws InputError for bad input.
int RunRelocalise(int argc, char** argv);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program view, installed as hullslam-view.
// Writes the report of a finished run or of a map. Parses the command line and returns the exit
// code. Throws InputError for bad input.
int RunView(int argc, char** argv);

}  // namespace hullslam

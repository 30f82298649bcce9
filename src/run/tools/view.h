// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program view, installed as hullslam-view.
// Shows a finished run or a map in a browser, or writes its report. Parses the command line and
// returns the exit code. Throws InputError for bad input.
int RunView(int argc, char** argv);

}  // namespace hullslam

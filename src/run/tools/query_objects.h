// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program query_objects.
// Answers questions about the objects of a run or of a saved map. Parses the command line and
// returns the exit code. Throws InputError for bad input.
int RunQueryObjects(int argc, char** argv);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program evaluate.
// Evaluates finished runs: the error of a trajectory against ground truth, and the mapped objects.
// Parses the command line and returns the exit code. Throws InputError for bad input.
int RunEvaluate(int argc, char** argv);

}  // namespace hullslam

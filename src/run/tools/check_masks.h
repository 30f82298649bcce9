// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program check_masks.
// Checks the masks of a sequence, counts the detections that they give, and can draw them. Parses
// the command line and returns the exit code. Throws InputError for bad input.
int RunCheckMasks(int argc, char** argv);

}  // namespace hullslam

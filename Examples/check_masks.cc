// SPDX-License-Identifier: GPL-3.0-or-later
// Checks the masks of a sequence, counts the detections that they give, and can draw them.
#include "run/tools/check_masks.h"

#include "run/program.h"

int main(int argc, char** argv) { return hullslam::RunMain(hullslam::RunCheckMasks, argc, argv); }

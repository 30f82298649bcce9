// SPDX-License-Identifier: GPL-3.0-or-later
// Measures how well single frames are found in a map of other frames of the same sequence.
#include "run/tools/relocalise.h"

#include "run/program.h"

int main(int argc, char** argv) { return hullslam::RunMain(hullslam::RunRelocalise, argc, argv); }

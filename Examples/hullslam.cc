// SPDX-License-Identifier: GPL-3.0-or-later
// The tools of HullSLAM in one program: `hullslam COMMAND`, see `hullslam --help`.
#include "run/program.h"
#include "run/tools/commands.h"

int main(int argc, char** argv) { return hullslam::RunMain(hullslam::RunHullslam, argc, argv); }

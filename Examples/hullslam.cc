// SPDX-License-Identifier: GPL-3.0-or-later
// The tools of HullSLAM in one program: `hullslam COMMAND`, see `hullslam --help`.
#include "run/tools/hullslam.h"

#include "run/program.h"

int main(int argc, char** argv) { return hullslam::RunMain(hullslam::RunHullslam, argc, argv); }

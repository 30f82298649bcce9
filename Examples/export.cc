// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a run or a map in a format of other programs.
#include "run/tools/export.h"

#include "run/program.h"

int main(int argc, char** argv) { return hullslam::RunMain(hullslam::RunExport, argc, argv); }

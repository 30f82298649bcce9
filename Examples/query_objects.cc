// SPDX-License-Identifier: GPL-3.0-or-later
// Answers questions about the objects of a run or of a saved map.
#include "run/tools/query_objects.h"

#include "run/program.h"

int main(int argc, char** argv) { return hullslam::RunMain(hullslam::RunQueryObjects, argc, argv); }

// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the report of a finished run or of a map as one file for a browser.
#include "run/tools/view.h"

#include "run/program.h"

int main(int argc, char** argv) { return hullslam::RunMain(hullslam::RunView, argc, argv); }

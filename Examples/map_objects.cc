// SPDX-License-Identifier: GPL-3.0-or-later
// Maps objects from masks and known camera poses. Colour images are not needed.
#include "run/tools/map_objects.h"

#include "run/program.h"

int main(int argc, char** argv) { return hullslam::RunMain(hullslam::RunMapObjects, argc, argv); }

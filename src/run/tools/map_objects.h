// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program map_objects.
// Maps objects from masks and known camera poses. Colour images are not needed. Parses the command
// line and returns the exit code. Throws InputError for bad input.
int RunMapObjects(int argc, char** argv);

}  // namespace hullslam

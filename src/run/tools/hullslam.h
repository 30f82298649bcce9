// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program hullslam: `hullslam COMMAND ...` runs a command of tools/commands.h. Returns the exit
// code. Throws InputError for bad usage or input.
int RunHullslam(int argc, char** argv);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program hullslam: `hullslam COMMAND ...` runs a command of tools/commands.h. A link to the
// program that has the name of a command's program, such as check_masks or hullslam-check_masks,
// runs this command. Returns the exit code. Throws InputError for bad usage or input.
int RunHullslam(int argc, char** argv);

}  // namespace hullslam

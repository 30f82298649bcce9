// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace hullslam {

// Adds --debug, which sends the library's log to stderr, including its debug messages on what
// happens to each object.
void AddDebugFlag(CLI::App& app);

}  // namespace hullslam

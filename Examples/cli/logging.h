// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace hullslam {

// Adds --debug: the library's log, down to what becomes of every object, goes to stderr.
void AddDebugFlag(CLI::App& app);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace hullslam {

// Adds --version, and what the exit codes mean to the end of --help. Subcommands that are added
// later show the exit codes too.
inline void AddVersionAndExitCodes(CLI::App& app, const std::string& done = "done",
                                   const std::string& failed = "the program failed",
                                   const std::string& bad_input = "bad usage or input") {
  app.set_version_flag("--version", HULLSLAM_VERSION);
  app.footer("Exit codes: 0 " + done + ", 1 " + failed + ", 2 " + bad_input + ".");
}

}  // namespace hullslam

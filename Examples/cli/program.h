// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "hullslam/util/error.h"

namespace hullslam {

enum ExitCode { kDone = 0, kFailed = 1, kBadInput = 2 };

// Parses the command line. Returns true if the program should go on, and false after options such
// as --help. Throws InputError if the command line cannot be parsed.
inline bool ParseCommandLine(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return true;
  } catch (const CLI::Success& request) {
    app.exit(request);
    return false;
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what());
  }
}

// Calls `run(argc, argv)` and returns its exit code. Turns an exception into one line on stderr and
// an exit code.
template <typename Run>
int RunMain(const Run& run, int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const InputError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return kFailed;
  }
}

}  // namespace hullslam

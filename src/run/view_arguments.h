// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/options.h"
#include "live/live_output.h"
#include "run/run_arguments.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

// Adds --view and --view-address.
void AddViewArguments(CLI::App& app, RunArguments& arguments);

// Adds --port and --view-address for a program whose pages do not change.
void AddPageArguments(CLI::App& app, int& port, std::string& address);

// The words of a command line, in which a --view without a port has the default port:
// "--view desk" becomes "--view=8320 desk".
std::vector<std::string> CompleteViewOption(int argc, char** argv);

// The live view of a run; without --view one that does nothing. Prints the address on stdout, also
// with --quiet, because the token in it cannot be guessed. Throws InputError if the address or the
// port cannot be used.
LiveOutput OpenLiveOutput(const RunArguments& arguments, const SystemOptions& options,
                          const ImageSequence& sequence,
                          const std::optional<Trajectory>& groundtruth);

// Shows a page until a signal ends the program. Prints its address. Throws InputError as above.
void ServePage(const std::string& page, int port, const std::string& address);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/mcap_output.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "hullslam/util/error.h"
#include "run/messages.h"
#include "util/components.h"

namespace hullslam {

void AddMcapOption(CLI::App& app, std::filesystem::path& file) {
  app.add_option("--mcap", file,
                 "file for a recording of the run, to be played by Foxglove, Rerun or ROS 2: "
                 "images, poses, landmarks and objects; replaces an earlier one")
      ->each([](const std::string&) { RequireComponent("BAGS", "--mcap is given"); });
}

std::string WriteMcap(const RunArguments& arguments, const RecordedRun& run) {
  if (arguments.mcap.empty()) {
    return {};
  }
  if (!arguments.quiet) {
    PrintError("writing {}\n", arguments.mcap.string());
  }
  try {
    const size_t missing = WriteRecording(arguments.mcap, run);
    if (missing > 0) {
      PrintError("warning: {}: {} images could not be read and are not in it\n",
                 arguments.mcap.string(), missing);
    }
  } catch (const InputError& error) {
    return fmt::format("{}; the recording was not written, the other results were", error.what());
  }
  return {};
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/more_outputs.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "files/staged_file.h"
#include "hullslam/util/error.h"
#include "run/messages.h"
#include "util/components.h"
#include "view/report.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

std::string PageOf(const Report& report) {
  for (const std::string& note : report.notes) {
    PrintError("report: {}\n", note);
  }
  return report.page;
}

}  // namespace

void AddReportFlag(CLI::App& app, bool& report) {
  app.add_flag("--report", report,
               "also write report.html to the output folder: the map in 3D, errors, times, images "
               "and objects, to be opened in a browser")
      ->each([](const std::string&) { RequireComponent("LIVE", "--report is given"); });
}

std::string WriteReport(const fs::path& folder, const Map& map, const SystemOptions& options,
                        const ImageSequence& sequence, bool is_quiet) {
  try {
    const fs::path file = folder / "report.html";
    WriteFileAtomically(file, PageOf(MakeReport(folder, map, options, sequence)));
    if (!is_quiet) {
      Print("the report is in {}\n", file.string());
    }
  } catch (const std::exception& error) {
    return fmt::format("the report could not be written: {}; the results are complete",
                       error.what());
  }
  return {};
}

std::string ReportOf(const fs::path& source) {
  return PageOf(MakeReportOf(source, HULLSLAM_VERSION));
}

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/more_outputs.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <system_error>

#include "datasets/run_files.h"
#include "files/paths.h"
#include "files/staged_file.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/util/error.h"
#include "run/program.h"
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

void CheckSavedFile(const char* option, const fs::path& file, const RunArguments& arguments) {
  if (file.empty()) {
    return;
  }
  for (const fs::path& input : {arguments.sequence, arguments.masks, arguments.settings,
                                arguments.associations, arguments.vocabulary}) {
    if (!input.empty() && IsSameOrInside(file, input)) {
      throw InputError(
          fmt::format("{} is '{}', which is or is inside {}, which this run "
                      "reads; choose another path",
                      option, file.string(), input.string()));
    }
  }
  if (IsSameOrInside(file, arguments.output)) {
    throw InputError(
        fmt::format("{} is '{}', which is in the output folder; the next run "
                    "replaces the files there, so choose another path",
                    option, file.string()));
  }
  const fs::path folder = CanonicalPath(file).parent_path();
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(fmt::format("{} is '{}', but there is no folder {}", option, file.string(),
                                 folder.string()));
  }
  ProbeFile(file);
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

void CheckSavedFiles(const RunArguments& arguments) {
  CheckSavedFile("--save-map", arguments.save_map, arguments);
  CheckSavedFile("--mcap", arguments.mcap, arguments);
}

SystemStart LoadStart(const RunArguments& arguments, const SystemOptions& options) {
  SystemStart start;
  start.session_name = CanonicalName(arguments.sequence);
  start.localization_only = arguments.localization;
  if (!arguments.load_map.empty()) {
    start.map = ReadMap(arguments.load_map, options, &Interruption());
  }
  return start;
}

std::string SaveMap(const RunArguments& arguments, const SystemOptions& options, const Map& map) {
  if (arguments.save_map.empty()) {
    return {};
  }
  if (map.keyframes().empty()) {
    PrintError("warning: {}: the map has no keyframe and was not written\n",
               arguments.save_map.string());
    return {};
  }
  try {
    WriteMap(arguments.save_map, map, MapSettingsOf(options));
  } catch (const InputError& error) {
    return fmt::format("{}; an earlier map there and the other results are kept", error.what());
  }
  return {};
}

std::string SaveIslands(const RunArguments& arguments, const SystemOptions& options,
                        std::span<const LeftIsland> islands) {
  for (const LeftIsland& island : islands) {
    RunArguments of_island = arguments;
    if (!arguments.save_map.empty()) {
      of_island.save_map.replace_filename(arguments.save_map.stem().string() +
                                          IslandSuffix(island.id) +
                                          arguments.save_map.extension().string());
    }
    if (std::string error = SaveMap(of_island, options, *island.map); !error.empty()) {
      return error;
    }
  }
  return {};
}

std::optional<std::string> SessionTitle(const RunArguments& arguments, size_t earlier_sessions) {
  if (arguments.load_map.empty()) {
    return std::nullopt;
  }
  const std::string name = CanonicalName(arguments.sequence);
  return arguments.localization ? "localization: " + name
                                : TitleOfSession(earlier_sessions + 1, name);
}

}  // namespace hullslam

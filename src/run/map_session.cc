// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/map_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "datasets/run_files.h"
#include "files/paths.h"
#include "files/staged_file.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/util/error.h"
#include "run/interrupt.h"
#include "run/messages.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

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
    return fmt::format("{}; the map is lost, the other results were written", error.what());
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

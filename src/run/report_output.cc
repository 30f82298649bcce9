// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/report_output.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <map>
#include <sstream>
#include <utility>

#include "files/atomic_file.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/settings/settings.h"
#include "run/messages.h"
#include "system/make_sensor.h"
#include "view/aligned_truth.h"
#include "view/fit_size.h"
#include "view/report_page.h"
#include "view/view_of_map.h"
#include "view/view_of_run.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReportFile = "report.html";

// The settings as keys and values.
std::map<std::string, std::string> SettingsByKey(const SystemOptions& options) {
  std::map<std::string, std::string> settings;
  std::istringstream lines(FormatSettings(options));
  for (std::string line; std::getline(lines, line);) {
    const size_t colon = line.find(": ");
    if (colon != std::string::npos && line.front() != '%' && line.front() != '#') {
      settings[line.substr(0, colon)] = line.substr(colon + 2);
    }
  }
  return settings;
}

// The calibration differs from the default in every run, so it is left out.
ViewSettings CompareWithDefaults(const SystemOptions& options) {
  ViewSettings settings;
  settings.explanation = "The calibration of the camera (Camera.*) is left out.";
  const std::map<std::string, std::string> defaults = SettingsByKey(SystemOptions());
  for (const auto& [key, value] : SettingsByKey(options)) {
    const auto standard = defaults.find(key);
    const std::string text = standard != defaults.end() ? standard->second : std::string();
    if (!key.starts_with("Camera.") && value != text) {
      settings.changed.push_back({key, value, text});
    }
  }
  return settings;
}

// Thins the model and says what was left out.
std::string PageOf(ViewModel model) {
  ThinToFit(kMostReportBytes - FormatPage({}).size(), model);
  for (const std::string& note : model.notes) {
    PrintError("report: {}\n", note);
  }
  return FormatReport(model);
}

}  // namespace

void AddReportFlag(CLI::App& app, bool& report) {
  app.add_flag("--report", report,
               "also write report.html to the output folder: the map in 3D, errors, times, images "
               "and objects, to be opened in a browser");
}

std::string WriteReport(const fs::path& folder, const Map& map, const SystemOptions& options,
                        const ImageSequence& sequence, bool is_quiet) {
  try {
    const Sensor sensor = MakeSensor(options);
    const ViewSettings settings = CompareWithDefaults(options);
    const fs::path file = folder / kReportFile;
    WriteFileAtomically(file, PageOf(ViewOfRun(folder, {.map = &map,
                                                        .sensor = &sensor,
                                                        .options = &options.objects,
                                                        .sequence = &sequence,
                                                        .settings = &settings})));
    if (!is_quiet) {
      Print("the report is in {}\n", file.string());
    }
  } catch (const std::exception& error) {
    return fmt::format("the report could not be written: {}; the results are complete",
                       error.what());
  }
  return {};
}

std::string ReportOfRun(const fs::path& folder) { return PageOf(ViewOfRun(folder)); }

std::string ReportOfMap(const fs::path& map) {
  const StoredMap stored = ReadMap(map);
  const SystemOptions options = OptionsOf(stored.settings);
  ViewModel model = ViewOfMap(stored.map, MakeSensor(options), options.objects);
  AddUp(std::nullopt, model);
  model.title = map.filename().string();
  model.version = HULLSLAM_VERSION;
  return PageOf(std::move(model));
}

}  // namespace hullslam

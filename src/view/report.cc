// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/report.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <utility>

#include "files/content_hash.h"
#include "files/read_file.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/util/error.h"
#include "system/make_sensor.h"
#include "view/aligned_truth.h"
#include "view/fit_size.h"
#include "view/report_page.h"
#include "view/view_of_map.h"
#include "view/view_of_run.h"

namespace hullslam {
namespace {

// The settings as keys and values.
std::map<std::string, std::string> SettingsByKey(SystemOptions options) {
  std::map<std::string, std::string> settings;
  for (const OptionTable::Entry& entry : options.Bind().Entries()) {
    if (!entry.is_shared) {
      settings[entry.key] = entry.value;
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
    const auto found = defaults.find(key);
    const std::string standard = found != defaults.end() ? found->second : std::string();
    if (!key.starts_with("Camera.") && value != standard) {
      settings.changed.push_back({key, value, standard});
    }
  }
  return settings;
}

// Thins the model, so that browsers can show it.
Report Format(ViewModel model) {
  ThinToFit(kMostReportBytes - FormatPage({}).size(), model);
  return {FormatReport(model), model.notes};
}

// The report of a file of --save-map.
Report ReportOfMap(const std::filesystem::path& map, const std::string& version) {
  const StoredMap stored = ReadMap(map);
  const SystemOptions options = OptionsOf(stored.settings);
  ViewModel model = ViewOfMap(stored.map, MakeSensor(options), options.objects);
  AddUp(std::nullopt, model);
  model.title = map.filename().string();
  model.version = version;
  return Format(std::move(model));
}

// The last line of a report that a run itself has written, with the hash of the run's summary;
// empty without a summary.
std::string MarkOf(const std::filesystem::path& folder) {
  try {
    const std::string summary = ReadFile(folder / "summary.json");
    return fmt::format("<!-- written by the run with the summary {} -->\n",
                       ContentHash(summary.data(), summary.size()));
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

Report MakeReport(const std::filesystem::path& folder, const Map& map, const SystemOptions& options,
                  const ImageSequence& sequence) {
  const Sensor sensor = MakeSensor(options);
  const ViewSettings settings = CompareWithDefaults(options);
  Report report = Format(ViewOfRun(folder, {.map = &map,
                                            .sensor = &sensor,
                                            .options = &options.objects,
                                            .sequence = &sequence,
                                            .settings = &settings}));
  report.page += MarkOf(folder);
  return report;
}

bool HasOwnReport(const std::filesystem::path& folder) {
  constexpr size_t kMostBytes = 100'000'000;
  const std::string mark = MarkOf(folder);
  try {
    return !mark.empty() && ReadFile(folder / "report.html", kMostBytes).ends_with(mark);
  } catch (const InputError&) {
    return false;
  }
}

Report MakeReport(const std::filesystem::path& folder) { return Format(ViewOfRun(folder)); }

Report MakeReportOf(const std::filesystem::path& source, const std::string& version) {
  if (!std::filesystem::exists(source)) {
    throw InputError(source.string() +
                     ": does not exist, expected the output folder of a run or a map file");
  }
  return std::filesystem::is_directory(source) ? MakeReport(source) : ReportOfMap(source, version);
}

std::filesystem::path DefaultReportPath(const std::filesystem::path& source) {
  std::filesystem::path beside = source;
  return std::filesystem::is_directory(source) ? source / "report.html"
                                               : beside.replace_extension(".html");
}

}  // namespace hullslam

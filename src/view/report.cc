// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "files/content_hash.h"
#include "files/read_file.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/util/error.h"
#include "results/finished_run.h"
#include "results/output_folder.h"
#include "system/make_sensor.h"
#include "util/text.h"
#include "view/aligned_truth.h"
#include "view/fit_size.h"
#include "view/report_page.h"
#include "view/view_message.h"
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

constexpr size_t kMostBytes = 2'000'000'000;  // of a file

// The hash of a file; empty if it cannot be read.
std::string HashOf(const std::filesystem::path& file) {
  try {
    const std::string content = ReadFile(file, kMostBytes);
    return fmt::format("{}", ContentHash(content.data(), content.size()));
  } catch (const InputError&) {
    return {};
  }
}

// The last line of a report that a run itself has written. It begins with the hash of the run's
// summary; `hullslam mesh` makes the surface later.
struct Mark {
  explicit Mark(const std::filesystem::path& folder)
      : begin("<!-- written by the run with the summary " + HashOf(folder / "summary.json") + " "),
        line(begin + HashOf(folder / kSurfaceFile) + "-->\n") {}

  std::string begin;
  std::string line;
};

// The report in the folder, if its last line begins with the mark; empty otherwise.
std::string ReadOwnReport(const std::filesystem::path& folder, const Mark& mark) {
  try {
    std::string page = ReadFile(folder / "report.html", kMostBytes);
    const size_t line = page.rfind("<!--");
    return line != std::string::npos && page.compare(line, mark.begin.size(), mark.begin) == 0
               ? page
               : std::string();
  } catch (const InputError&) {
    return {};
  }
}

// The message in a page; null if there is none of this version.
nlohmann::json MessageIn(const std::string& page) {
  constexpr std::string_view kBegin = "id=\"hullslam-data\">";
  const size_t begin = page.find(kBegin);
  const size_t end = page.find("</script>", begin);
  if (begin == std::string::npos || end == std::string::npos) {
    return nullptr;
  }
  const size_t first = begin + kBegin.size();
  nlohmann::json message = nlohmann::json::parse(page.substr(first, end - first), nullptr, false);
  const nlohmann::json::json_pointer notes("/set/run/notes");
  return message.is_object() && message["view"] == kViewVersion && message.contains(notes) &&
                 message[notes].is_array()
             ? message
             : nlohmann::json();
}

// The report that the run has written, with the surface that there is now. Nothing if there is no
// such report.
std::optional<Report> OwnReport(const std::filesystem::path& folder) {
  const Mark mark(folder);
  const std::string page = ReadOwnReport(folder, mark);
  if (page.ends_with(mark.line)) {
    return Report{page, {}};
  }
  nlohmann::json message = MessageIn(page);
  if (message.is_null()) {
    return std::nullopt;
  }
  nlohmann::json::array_t notes;  // without those about a former surface
  for (const nlohmann::json& note : message["set"]["run"]["notes"]) {
    if (!note.is_string() || note.get<std::string>().find("surface") == std::string::npos) {
      notes.push_back(note);
    }
  }
  message["set"].erase("surface");
  ViewModel model;
  AddSurface(OpenFinishedRun(folder), model);
  const size_t used = FormatPage(DumpViewMessage(message)).size();
  ThinToFit(kMostReportBytes - std::min(kMostReportBytes, used), model);
  if (!model.surface.triangles.empty()) {
    message["set"]["surface"] = SurfaceJson(model.surface);
  }
  for (const std::string& note : model.notes) {
    notes.push_back(Printable(note));
  }
  message["set"]["run"]["notes"] = std::move(notes);
  return Report{FormatPage(DumpViewMessage(message)) + mark.line, model.notes};
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
  report.page += Mark(folder).line;
  return report;
}

bool HasOwnReport(const std::filesystem::path& folder) {
  const Mark mark(folder);
  return ReadOwnReport(folder, mark).ends_with(mark.line);
}

Report MakeReport(const std::filesystem::path& folder) {
  const std::optional<Report> own = OwnReport(folder);
  return own ? *own : Format(ViewOfRun(folder));
}

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

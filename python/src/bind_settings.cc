// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/settings/settings.h"
#include "module.h"
#include "types.h"

namespace hullslam::python {
namespace {

namespace py = pybind11;

constexpr const char* kOrigin = "Settings";  // names the keyword arguments in messages

// The camera of settings that have no file.
CameraCalibration CameraOf(const std::vector<std::string>& overrides) {
  SystemOptions given;
  OptionTable table = given.Bind();
  for (const std::string& assignment : overrides) {
    const size_t equals = assignment.find('=');
    if (assignment.starts_with("Camera.") && equals != std::string::npos) {
      table.Set(assignment.substr(0, equals), assignment.substr(equals + 1), kOrigin);
    }
  }
  return {.camera = given.camera, .frames_per_second = given.frames_per_second};
}

SettingsTable MakeTable(const std::optional<std::filesystem::path>& file,
                        const std::optional<std::string>& preset,
                        const std::vector<std::string>& overrides) {
  const std::optional<Preset> read = preset ? std::optional(ReadPreset(*preset)) : std::nullopt;
  const SettingsSources sources{
      .preset = read ? &*read : nullptr, .overrides = overrides, .overrides_origin = kOrigin};
  SettingsNotes report;
  SystemOptions options = file ? ReadSettings(*file, sources, report)
                               : MakeSettings(CameraOf(overrides), kOrigin, sources, report);
  return {.options = std::move(options), .warnings = std::move(report.warnings)};
}

// One tuple per setting: key, value, default, expected value, meaning, and whether it only sets
// other keys.
py::list Entries(const SettingsTable& table) {
  SystemOptions defaults;
  std::map<std::string, std::string> default_values;
  for (const OptionTable::Entry& entry : defaults.Bind().Entries()) {
    default_values[entry.key] = entry.value;
  }
  SystemOptions options = table.options;
  py::list entries;
  for (const OptionTable::Entry& entry : options.Bind().Entries()) {
    entries.append(py::make_tuple(entry.key, entry.value, default_values[entry.key], entry.expected,
                                  entry.help, entry.is_shared));
  }
  return entries;
}

// The options are checked together when they are used, because a caller sets them one by one.
void Set(SettingsTable& table, const std::string& key, const std::string& value) {
  SystemOptions options = table.options;
  options.Bind().Set(key, value, kOrigin);
  table.options = std::move(options);
}

}  // namespace

void BindSettings(py::module_& module) {
  py::class_<SettingsTable>(module, "SettingsTable",
                            "The registry of settings. hullslam.Settings is derived from it.")
      .def(py::init(&MakeTable), py::arg("file") = py::none(), py::arg("preset") = py::none(),
           py::arg("overrides") = std::vector<std::string>())
      .def(py::init<const SettingsTable&>(), py::arg("other"), "A copy.")
      .def_readonly("warnings", &SettingsTable::warnings,
                    "What the reader has to say about the settings: list of str.")
      .def("entries", &Entries,
           "Key, value, default, expected value, meaning and is_shared of all settings.")
      .def_static(
          "defaults", [] { return Entries({}); }, "entries() with all values at their default.")
      .def("set_text", &Set, py::arg("key"), py::arg("text"),
           "Sets one setting from text, as a settings file has it.")
      .def(
          "format", [](const SettingsTable& table) { return FormatSettings(table.options); },
          "All settings as the text of a settings file.")
      .def_property_readonly(
          "hash", [](const SettingsTable& table) { return HashSettings(table.options); },
          "16 hexadecimal digits that change with every setting; `summary.json` has them too.")
      .def_property_readonly(
          "image_size",
          [](const SettingsTable& table) {
            return py::make_tuple(table.options.camera.width, table.options.camera.height);
          },
          "Width and height of the images, px.");
  module.def("preset_names", &PresetNames, "The names of the presets (docs/presets.md).");
  module.def(
      "default_settings",
      [](const std::filesystem::path& sequence) {
        return FindDefaultSettings(sequence, FindConfigFolder());
      },
      py::arg("sequence"),
      "The path of the settings file of a sequence: `camera.yaml` in its folder, else the file\n"
      "for the TUM camera that the name of the folder contains (fr1, freiburg2 ...). Raises\n"
      "InputError if there is neither.");
}

}  // namespace hullslam::python

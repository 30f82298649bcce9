// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/dataset_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>
#include <tuple>

#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "run/load_settings.h"
#include "run/messages.h"

namespace hullslam {
namespace {

constexpr double kMostNumber = 1e12;

bool IsNumber(const DatasetOption& option) {
  const std::string_view type = option.type;
  return type == "N" || type == "DEGREES" || type == "SECONDS";
}

// The options of all data sets, each once.
std::vector<DatasetOption> AllOptions() {
  std::vector<DatasetOption> all;
  for (const Dataset& dataset : Datasets()) {
    for (const DatasetOption& option : dataset.options) {
      if (std::ranges::none_of(all, [&](const DatasetOption& other) {
            return std::string_view(other.name) == option.name;
          })) {
        all.push_back(option);
      }
    }
  }
  return all;
}

const DatasetOption* FindOption(std::span<const DatasetOption> options, std::string_view key) {
  const auto found =
      std::ranges::find_if(options, [&](const DatasetOption& option) { return option.key == key; });
  return found != options.end() ? &*found : nullptr;
}

}  // namespace

void AddDatasetOptions(CLI::App& app, std::span<const DatasetOption> options,
                       DatasetChoices& choices) {
  for (const DatasetOption& option : options) {
    const std::string name = std::string("--") + option.name;
    if (option.flag != nullptr) {
      app.add_flag_callback(
          name, [&choices, option] { choices[option.key] = option.flag; }, option.meaning);
      continue;
    }
    CLI::Option* const added = app.add_option_function<std::string>(
        name, [&choices, option](const std::string& text) { choices[option.key] = text; },
        option.meaning);
    added->type_name(option.type);
    if (IsNumber(option)) {
      ExpectNumber(*added, -kMostNumber, kMostNumber);
    }
  }
}

void AddAnyDatasetOptions(CLI::App& app, AnyDatasetArguments& arguments) {
  for (const auto& [name, sensor, meaning] :
       {std::tuple("--mono", SensorKind::kMonocular, "use one camera"),
        std::tuple("--rgbd", SensorKind::kRgbd, "use depth images"),
        std::tuple("--stereo", SensorKind::kStereo, "use both cameras of a stereo camera")}) {
    app.add_flag_callback(
        name, [&arguments, kind = sensor] { arguments.sensor = kind; },
        std::string(meaning) +
            " (default: depth images if there are some, else a pair, else one "
            "camera)");
  }
  AddDatasetOptions(app, AllOptions(), arguments.choices);
}

std::vector<DatasetOption> OptionsOfImages() {
  std::vector<DatasetOption> options = AllOptions();
  std::erase_if(options, [](const DatasetOption& option) {
    const std::string_view key = option.key;
    return key != "image_topic" && key != "times" && key != "side_by_side";
  });
  return options;
}

DatasetHelp HelpOfAnyDataset() {
  return {.sequence =
              "what a SLAM program reads: a sequence of TUM, ICL-NUIM, EuRoC or KITTI, stereo "
              "pairs, a recording of ROS, a video or a folder of images",
          .settings = "default: those of the sequence; a video or a folder of images has none",
          .associations = "stamp rgb stamp depth",
          .groundtruth = "default: that of the sequence"};
}

FoundDataset FindGivenDataset(const std::filesystem::path& path,
                              const AnyDatasetArguments& arguments) {
  std::optional<SensorKind> sensor = arguments.sensor;
  if (!sensor && arguments.choices.contains("side_by_side")) {
    sensor = SensorKind::kStereo;
  }
  FoundDataset found = FindDataset(path, sensor);
  for (const auto& [key, value] : arguments.choices) {
    if (FindOption(found.dataset->options, key) == nullptr) {
      const std::vector<DatasetOption> all = AllOptions();
      throw InputError(fmt::format("--{} is given, but {} is {}, which has no such choice",
                                   FindOption(all, key)->name, path.string(),
                                   found.dataset->meaning));
    }
  }
  return found;
}

OpenedDataset OpenDatasetLoudly(const Dataset& dataset, const DatasetRequest& request) {
  OpenedDataset opened = OpenDataset(dataset, request);
  PrintSettingsWarnings(opened.settings);
  return opened;
}

OpenedDataset OpenAnyDataset(const AnyDatasetArguments& arguments, DatasetRequest request) {
  AnyDatasetArguments given = arguments;
  if (!given.sensor && !request.associations.empty()) {
    given.sensor = SensorKind::kRgbd;
  }
  const FoundDataset found = FindGivenDataset(request.path, given);
  request.sensor = found.sensor;
  request.choices = given.choices;
  return OpenDatasetLoudly(*found.dataset, request);
}

std::string ProgramOf(const Dataset& dataset, SensorKind sensor) {
  const char* const prefix = sensor == SensorKind::kRgbd     ? "rgbd"
                             : sensor == SensorKind::kStereo ? "stereo"
                                                             : "mono";
  return fmt::format("{}_{}", prefix, dataset.program);
}

}  // namespace hullslam

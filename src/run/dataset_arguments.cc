// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/dataset_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <string_view>
#include <tuple>
#include <utility>

#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "run/program.h"

namespace hullslam {
namespace {

constexpr double kMostNumber = 1e12;

bool IsNumber(const DatasetOption& option) {
  const std::string_view type = option.type;
  return type == "N" || type == "DEGREES" || type == "SECONDS";
}

// The names of the presets for --help. Help must also work without the folder of presets.
std::string ListPresets() {
  try {
    return fmt::format("{}", fmt::join(PresetNames(), ", "));
  } catch (const InputError&) {
    return "a name of config/presets";
  }
}

}  // namespace

void AddSelection(CLI::App& app, FrameSelection& selection) {
  app.add_option("--first", selection.first,
                 "number of the first frame, counted from 0 (default: 0)")
      ->check(WholeNumber(0));
  app.add_option("--last", selection.last,
                 "number of the last frame, inclusive (default: last of the sequence)")
      ->check(WholeNumber(0));
  app.add_option("--stride", selection.stride, "use every n-th frame only (default: 1)")
      ->check(WholeNumber(1));
}

void AddSettingsArgument(CLI::App& app, const std::string& rule, std::filesystem::path& settings) {
  app.add_option("--settings", settings, "settings file (" + rule + ")");
}

void AddPresetArgument(CLI::App& app, std::string& preset) {
  app.add_option("--preset", preset,
                 "work as a published system does: " + ListPresets() +
                     "; or a FILE that ends in .yaml. The settings file and --set replace its "
                     "settings")
      ->type_name("NAME|FILE");
}

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
  AddDatasetOptions(app, AllDatasetOptions(), arguments.choices);
}

OpenedDataset OpenDatasetLoudly(const Dataset& dataset, const DatasetRequest& request) {
  OpenedDataset opened = OpenDataset(dataset, request);
  PrintWarnings(opened.settings.notes.warnings);
  return opened;
}

OpenedDataset OpenAnyDataset(const AnyDatasetArguments& arguments, DatasetRequest request) {
  request.choices = arguments.choices;
  OpenedDataset opened = OpenFoundDataset(arguments.sensor, std::move(request));
  PrintWarnings(opened.settings.notes.warnings);
  return opened;
}

std::optional<Trajectory> FindGroundtruth(const ImageSequence& sequence) {
  std::vector<std::string> warnings;
  std::optional<Trajectory> truth = TryGroundtruth(sequence, warnings);
  PrintWarnings(warnings);
  return truth;
}

void AddMaskFormat(CLI::App& app, std::string& format, const std::string& names) {
  app.add_option(names, format,
                 fmt::format("format of the masks: {} (default: detected from the files)",
                             fmt::join(MaskFormatNames(), ", ")))
      ->check(CLI::IsMember(MaskFormatNames()).description(""));
}

void AddMaskArguments(CLI::App& app, std::filesystem::path& path, std::string& format) {
  app.add_option("--masks", path,
                 "instance masks of the objects: a folder or a JSON file (docs/masks.md)");
  AddMaskFormat(app, format, "--masks-format");
}

void AddRightMaskArgument(CLI::App& app, std::filesystem::path& path) {
  app.add_option("--masks-right", path,
                 "instance masks of the right images, in the format of --masks: more lines of the "
                 "same objects")
      ->needs("--masks");
}

void AddMaskAllArgument(CLI::App& app, std::filesystem::path& path) {
  app.add_option("--mask-all", path,
                 "one mask for all images, such as that of the robot's own arm, a bonnet or a "
                 "watermark: a PNG of their size, whose black pixels (0) are ignored in each image "
                 "(docs/masks.md)");
}

void AddRightMaskAllArgument(CLI::App& app, std::filesystem::path& path) {
  app.add_option("--mask-all-right", path, "the same for the right images");
}

void AddNetworkArguments(CLI::App& app, std::filesystem::path& network, size_t& every) {
  CLI::Option* const segment =
      app.add_option("--segment", network,
                     "network that makes the masks, a file of ONNX (docs/segmentation.md); with "
                     "--realtime, masks come when they are ready")
          ->excludes("--masks");
  app.add_option("--segment-every", every,
                 "without --realtime: make masks of every n-th frame and of all keyframes")
      ->check(WholeNumber(1))
      ->needs(segment)
      ->capture_default_str();
}

void AddSegmenterOptions(CLI::App& app, SegmenterOptions& options) {
  app.add_option("--names", options.names,
                 "file with the name of one class per line (default: those in the network's file)");
  app.add_option("--classes", options.classes, "only these classes, separated by commas")
      ->delimiter(',');
  ExpectNumber(*app.add_option("--min-score", options.min_score, "least score of an instance")
                    ->capture_default_str(),
               0.0, 1.0);
  app.add_option("--size", options.size,
                 "longer side of the image that the network sees, px (default: as its input)")
      ->check(WholeNumber(1));
  app.add_option("--threads", options.threads, "threads of the network (default: all cores)")
      ->check(WholeNumber(1));
  app.add_flag("--boxes", options.use_boxes,
               "use the boxes of a network that finds no masks; the format is boxes");
}

MaskRequest RequestOf(const std::filesystem::path& path, const std::string& format,
                      const ImageSequence& sequence, const PinholeCamera& camera) {
  if (path.empty() && !format.empty()) {
    throw InputError(
        fmt::format("--masks-format is '{}' without --masks, expected both or neither", format));
  }
  const cv::Size size = SizeAsRead(sequence, camera);
  return {path, format, size.width, size.height};
}

}  // namespace hullslam

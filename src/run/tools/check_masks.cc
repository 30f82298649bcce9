// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "frame/detection_builder.h"
#include "hullslam/masks/open_masks.h"
#include "masks/mask_overlay.h"
#include "results/output_folder.h"
#include "run/command_line.h"
#include "run/dataset_arguments.h"
#include "run/input_warnings.h"
#include "run/interrupt.h"
#include "run/load_settings.h"
#include "run/mask_arguments.h"
#include "run/messages.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/tools/commands.h"
#include "run/tools/view_images.h"
#include "sequences/image_file.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostFaultsShown = 20;

struct CheckMasksArguments {
  fs::path sequence;
  fs::path masks;
  std::string format;
  fs::path settings;
  fs::path associations;
  AnyDatasetArguments any;
  std::string preset;
  std::vector<std::string> overrides;
  fs::path output;  // empty: no pictures
  size_t every = 50;
  bool quiet = false;
};

// The instances of one class: how many there are, and how many give a detection.
struct ClassCount {
  size_t instances = 0;
  size_t kept = 0;
  double score_sum = 0.0;
};

struct MaskStatistics {
  size_t frames = 0;
  size_t missing = 0;
  size_t without_masks = 0;
  size_t without_image = 0;
  size_t without_depth = 0;
  size_t instances = 0;
  size_t crowds = 0;
  size_t without_area = 0;
  std::array<size_t, kDetectionRejectionCount> rejections{};
  size_t detections = 0;
  size_t cut = 0;
  size_t lines = 0;
  size_t one_sided = 0;
  std::map<std::string, ClassCount> classes;
  std::vector<std::string> faults;
  size_t pictures = 0;
};

void AddOptions(CLI::App& app, CheckMasksArguments& arguments) {
  const DatasetHelp help = HelpOfAnyDataset();
  app.add_option("SEQUENCE", arguments.sequence,
                 help.sequence + "; the images in a list of TUM may be missing")
      ->required();
  app.add_option("MASKS", arguments.masks,
                 "masks of the sequence: a folder or a JSON file (docs/masks.md)")
      ->required();
  AddMaskFormat(app, arguments.format, "--format,--masks-format");
  AddSettingsArgument(app, help.settings, arguments.settings);
  app.add_option(
      "--associations", arguments.associations,
      "file with one pair of images per line: stamp rgb stamp depth (default: images are "
      "paired by their stamps, at most 0.02 s apart)");
  AddAnyDatasetOptions(app, arguments.any);
  AddPresetArgument(app, arguments.preset);
  AddOverrides(app, arguments.overrides);
  app.add_option(
      "--output", arguments.output,
      "folder for the pictures; replaces the former pictures in it (default: no pictures "
      "are drawn)");
  app.add_option("--every", arguments.every, "draw the first frame and every n-th frame after it")
      ->check(CLI::Range(size_t{1}, size_t{1'000'000'000}).description(""))
      ->capture_default_str();
  app.add_flag("--quiet", arguments.quiet, "do not show the progress");
  AddVersionAndExitCodes(app, "all masks and images can be read",
                         "the program failed or was interrupted",
                         "some of them cannot be read, or bad usage");
}

void CountDetections(const FrameMasks& frame, const DetectionResult& result,
                     MaskStatistics& counts) {
  for (size_t i = 0; i < frame.masks.size(); ++i) {
    ClassCount& of_class = counts.classes[frame.masks[i].label];
    ++of_class.instances;
    of_class.score_sum += frame.masks[i].score;
    if (const auto& rejection = result.rejections.at(i)) {
      ++counts.rejections.at(static_cast<size_t>(*rejection));
    } else {
      ++of_class.kept;
    }
  }
  counts.detections += result.detections.size();
  for (const Detection& detection : result.detections) {
    counts.cut += detection.is_cut ? 1 : 0;
    counts.lines += detection.lines.size();
    for (const SilhouetteLine& line : detection.lines) {
      counts.one_sided += line.is_one_sided ? 1 : 0;
    }
  }
}

// The image. If its file is missing, a grey area of the size of the camera's images.
cv::Mat Background(const cv::Mat& grey, const PinholeCamera& camera) {
  return grey.empty() ? cv::Mat(camera.height, camera.width, CV_8UC1, cv::Scalar(96)) : grey;
}

void DrawFrame(const std::string& name, const cv::Mat& grey, const PinholeCamera& camera,
               const FrameMasks& frame, const DetectionResult& result, OutputFolder& output) {
  output.Write({name, EncodeImage(DrawMasks(grey, camera, frame.masks, result), ".png")});
}

// Counts the masks of one frame and, if `output` is given, draws them. If its masks or images
// cannot be read, this is recorded as a fault.
void CheckFrame(const CheckMasksArguments& arguments, const OpenedDataset& opened,
                const MaskSource& source, const FramePaths& paths, const MaskFrame& names,
                OutputFolder* output, MaskStatistics& counts) {
  const SystemOptions& options = opened.settings.options;
  const PinholeCamera& camera = options.camera;
  const bool is_drawn = output != nullptr && counts.frames % arguments.every == 0;
  ++counts.frames;
  counts.without_image += HasImage(opened.sequence, paths) ? 0 : 1;
  counts.without_depth += paths.depth.empty() ? 1 : 0;
  try {
    FrameMasks frame = source.Read(names);
    CheckMasks(source, {&names, 1}, RequestOf(arguments.masks, {}, opened.sequence, camera));
    FitMasks(opened.sequence.warps, ImageSide::kLeft, frame.masks);
    counts.missing += frame.is_missing ? 1 : 0;
    counts.without_masks += frame.masks.empty() ? 1 : 0;
    counts.instances += frame.masks.size() + frame.without_area + frame.crowds;
    counts.without_area += frame.without_area;
    counts.crowds += frame.crowds;
    const ViewImages view = ReadView(opened.sequence, paths, camera, is_drawn);
    const DetectionBuilder builder(camera, options.depth.units_per_metre,
                                   options.objects.detection);
    const DetectionResult result = builder.Build(frame.masks, view.depth, {});
    CountDetections(frame, result, counts);
    if (is_drawn) {
      DrawFrame(names.stem + ".png", Background(view.grey, camera), camera, frame, result, *output);
      ++counts.pictures;
    }
  } catch (const InputError& error) {
    counts.faults.emplace_back(error.what());
  }
}

void PrintClasses(const MaskStatistics& counts) {
  size_t width = std::string("class").size();
  for (const auto& [label, of_class] : counts.classes) {
    width = std::max(width, label.size());
  }
  Print("\n{:<{}}{:>12}{:>10}{:>12}\n", "class", width, "instances", "kept", "mean score");
  for (const auto& [label, of_class] : counts.classes) {
    Print("{:<{}}{:>12}{:>10}{:>12.2f}\n", label, width, of_class.instances, of_class.kept,
          of_class.score_sum / static_cast<double>(of_class.instances));
  }
}

void PrintCounts(const CheckMasksArguments& arguments, const MaskSource& source,
                 const MaskStatistics& counts) {
  const auto print = [](const std::string& name, size_t count) {
    Print("{:<24}{:>10}\n", name, count);
  };
  Print("{} ({})\n", arguments.masks.string(), source.format());
  print("frames", counts.frames);
  print("without image", counts.without_image);
  print("without depth", counts.without_depth);
  print("without masks", counts.without_masks);
  print("  without file", counts.missing);
  print("malformed", counts.faults.size());
  print("instances", counts.instances);
  print("kept", counts.detections);
  print("  cut by the border", counts.cut);
  print("rejected: crowd", counts.crowds);
  print("rejected: no area", counts.without_area);
  for (size_t i = 0; i < counts.rejections.size(); ++i) {
    print("rejected: " + ToString(static_cast<DetectionRejection>(i)), counts.rejections[i]);
  }
  print("lines", counts.lines);
  print("  one-sided", counts.one_sided);
  if (!arguments.output.empty()) {
    Print("{} pictures are in {}\n", counts.pictures, arguments.output.string());
  }
  PrintClasses(counts);
}

void PrintFaults(const std::vector<std::string>& faults) {
  for (size_t i = 0; i < faults.size() && i < kMostFaultsShown; ++i) {
    PrintError("error: {}\n", faults[i]);
  }
  if (faults.size() > kMostFaultsShown) {
    PrintError("error: {} more frames cannot be read\n", faults.size() - kMostFaultsShown);
  }
}

// Null if no pictures are to be drawn.
std::unique_ptr<OutputFolder> OpenOutput(const CheckMasksArguments& arguments) {
  if (arguments.output.empty()) {
    return nullptr;
  }
  const std::vector<fs::path> inputs = {arguments.sequence, arguments.masks, arguments.settings,
                                        arguments.associations};
  return std::make_unique<OutputFolder>(arguments.output, "pictures.json", inputs);
}

void FinishOutput(OutputFolder& output) {
  const nlohmann::ordered_json index = {{"files", output.names()}};
  output.Write(
      {"pictures.json",
       index.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n'});
  output.Commit();
}

OpenedDataset OpenSequence(const CheckMasksArguments& arguments) {
  OpenedDataset opened = OpenAnyDataset(arguments.any, {.path = arguments.sequence,
                                                        .settings = arguments.settings,
                                                        .preset = arguments.preset,
                                                        .overrides = arguments.overrides,
                                                        .associations = arguments.associations,
                                                        .need_images = false});
  PrintWarnings(opened.sequence);
  opened.settings.options.objects.detection.min_keypoints = 0;  // no keypoints are extracted here
  return opened;
}

}  // namespace

int RunCheckMasks(int argc, char** argv) {
  CLI::App app(
      "Checks the masks of a sequence, counts the detections that they give, and can draw them.",
      argv[0]);
  CheckMasksArguments arguments;
  AddOptions(app, arguments);
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  const OpenedDataset opened = OpenSequence(arguments);
  const ImageSequence& sequence = opened.sequence;
  const PinholeCamera& camera = opened.settings.options.camera;
  const std::vector<MaskFrame> frames = MaskFrames(sequence);
  const auto source =
      OpenMasks(RequestOf(arguments.masks, arguments.format, sequence, camera), frames);
  CatchInterrupts();
  const auto output = OpenOutput(arguments);
  WarnOfMisplacedMasks(sequence, camera,
                       [&](size_t frame) { return source->Read(frames[frame]).masks; });
  MaskStatistics counts;
  Progress progress(frames.size(), arguments.quiet);
  for (size_t i = 0; i < frames.size() && !IsInterrupted(); ++i) {
    CheckFrame(arguments, opened, *source, sequence.frames[i], frames[i], output.get(), counts);
    progress.Show(i + 1);
  }
  progress.Clear();
  if (counts.frames < frames.size()) {
    PrintFailure(fmt::format("interrupted after {} of {} frames; no pictures were written",
                             counts.frames, frames.size()));
    return kFailed;
  }
  if (output != nullptr) {
    FinishOutput(*output);
  }
  PrintCounts(arguments, *source, counts);
  PrintFaults(counts.faults);
  return counts.faults.empty() ? kDone : kBadInput;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "hullslam/datasets/input_checks.h"
#include "hullslam/masks/open_masks.h"
#include "images/image_file.h"
#include "results/output_folder.h"
#include "run/command_line.h"
#include "run/dataset_arguments.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/tools/commands.h"
#include "segmentation/sequence_masks.h"
#include "view/mask_overlay.h"

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

// The image. If its file is missing, a grey area of the size of the camera's images.
cv::Mat Background(const cv::Mat& grey, const PinholeCamera& camera) {
  return grey.empty() ? cv::Mat(camera.height, camera.width, CV_8UC1, cv::Scalar(96)) : grey;
}

// Checks a frame and, if `output` is given, draws its masks. What cannot be read is recorded.
void CheckAndDraw(const CheckedSource& checked, size_t frame, const MaskFrame& names,
                  OutputFolder* output, MaskStatistics& counts) {
  try {
    const CheckedFrame found =
        CheckFrame(checked, checked.sequence.frames[frame], names, output != nullptr, counts);
    if (output != nullptr) {
      const cv::Mat picture = DrawMasks(Background(found.view.grey, checked.camera), checked.camera,
                                        found.masks.masks, found.result);
      output->Write({names.stem + ".png", EncodeImage(picture, ".png")});
    }
  } catch (const InputError& error) {
    counts.faults.emplace_back(error.what());
  }
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

// Returns the number of pictures.
size_t FinishOutput(OutputFolder& output) {
  const size_t pictures = output.names().size();
  const nlohmann::ordered_json index = {{"files", output.names()}};
  output.Write(
      {"pictures.json",
       index.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n'});
  output.Commit();
  return pictures;
}

OpenedDataset OpenSequence(const CheckMasksArguments& arguments) {
  OpenedDataset opened = OpenAnyDataset(arguments.any, {.path = arguments.sequence,
                                                        .settings = arguments.settings,
                                                        .preset = arguments.preset,
                                                        .overrides = arguments.overrides,
                                                        .associations = arguments.associations,
                                                        .need_images = false});
  PrintWarnings(opened.sequence.warnings);
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
  const MaskRequest request = RequestOf(arguments.masks, arguments.format, sequence, camera);
  const auto source = OpenMasks(request, frames);
  CatchInterrupts();
  const auto output = OpenOutput(arguments);
  PrintWarnings(CheckMaskPlaces(sequence, camera,
                                [&](size_t frame) { return source->Read(frames[frame]).masks; }));
  const DetectionBuilder builder(camera, opened.settings.options.depth.units_per_metre,
                                 opened.settings.options.objects.detection);
  const CheckedSource checked = {sequence, *source, request, camera, builder};
  MaskStatistics counts;
  Progress progress(frames.size(), arguments.quiet);
  for (size_t i = 0; i < frames.size() && !IsInterrupted(); ++i) {
    const bool is_drawn = output != nullptr && i % arguments.every == 0;
    CheckAndDraw(checked, i, frames[i], is_drawn ? output.get() : nullptr, counts);
    progress.Show(i + 1);
  }
  progress.Clear();
  if (counts.frames < frames.size()) {
    PrintFailure(fmt::format("interrupted after {} of {} frames; no pictures were written",
                             counts.frames, frames.size()));
    return kFailed;
  }
  const size_t pictures = output != nullptr ? FinishOutput(*output) : 0;
  Print("{} ({})\n{}", arguments.masks.string(), source->format(), DescribeCounts(counts));
  if (output != nullptr) {
    Print("{} pictures are in {}\n", pictures, arguments.output.string());
  }
  Print("{}", DescribeClasses(counts));
  PrintFaults(counts.faults);
  return counts.faults.empty() ? kDone : kBadInput;
}

}  // namespace hullslam

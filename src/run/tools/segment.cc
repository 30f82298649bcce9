// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "hullslam/segmentation/segmenter.h"
#include "run/command_line.h"
#include "run/dataset_arguments.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/tools/commands.h"
#include "segmentation/mask_folder.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

struct SegmentArguments {
  fs::path input;
  fs::path network;
  fs::path output;
  SegmenterOptions options;
  DatasetChoices choices;
  size_t every = 1;
  bool quiet = false;
};

void AddOptions(CLI::App& app, SegmentArguments& arguments) {
  app.add_option("INPUT", arguments.input,
                 "what a SLAM program reads: a sequence, a folder of images, a video, a recording "
                 "of ROS; of a stereo camera, the left images are used")
      ->required();
  app.add_option("--network", arguments.network, "the network, a file of ONNX")->required();
  app.add_option("--output", arguments.output,
                 "folder for the masks; those that a former call has made are kept")
      ->required();
  AddSegmenterOptions(app, arguments.options);
  app.add_option("--every", arguments.every, "only the first frame and every n-th frame after it")
      ->check(WholeNumber(1))
      ->capture_default_str();
  AddDatasetOptions(app, OptionsOfImages(), arguments.choices);
  app.add_flag("--quiet", arguments.quiet, "print nothing but warnings and errors");
  AddVersionAndExitCodes(app, "done", "the program failed or was interrupted");
}

MaskFolderWork SegmentAll(const SegmentArguments& arguments, const ImageSequence& sequence,
                          Segmenter& segmenter) {
  MaskFolderWork work = FindMaskWork(arguments.output, sequence, arguments.every);
  Progress progress(work.left.size(), arguments.quiet);
  for (size_t i = 0; i < work.left.size() && !IsInterrupted(); ++i) {
    MakeMaskFile(sequence, i, segmenter, work);
    progress.Show(i + 1);
  }
  progress.Clear();
  return work;
}

void PrintCounts(const SegmentArguments& arguments, const MaskFolderWork& counts) {
  for (const std::string& fault : counts.unread) {
    PrintError("warning: {}; this frame has no masks\n", fault);
  }
  if (counts.failed > 0) {
    PrintError("warning: the network fails on {}, which {} no masks; the first is {}\n",
               Counted(counts.failed, "image"), counts.failed == 1 ? "has" : "have",
               counts.first_failure);
  }
  if (counts.made > 0 && counts.instances.empty()) {
    PrintError(
        "warning: the network found nothing in {}; is it for such images, and are their colours "
        "right? --min-score {:g} may be too high\n",
        Counted(counts.made, "image"), arguments.options.min_score);
  }
  if (arguments.quiet) {
    return;
  }
  Print("{}: masks of {} of {} frames, {} of them new\n", arguments.output.string(), counts.done,
        counts.frames, counts.made);
  for (const auto& [label, count] : counts.instances) {
    Print("{:<24}{:>10}\n", label, count);
  }
}

}  // namespace

int RunSegment(int argc, char** argv) {
  CLI::App app("Makes the masks of the objects in images with a network (docs/segmentation.md).",
               argv[0]);
  SegmentArguments arguments;
  AddOptions(app, arguments);
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  Segmenter segmenter(arguments.network, arguments.options);
  const ImageSequence sequence = OpenImages(arguments.input, arguments.choices);
  PrintWarnings(sequence.warnings);
  PrepareMaskFolder(arguments.output, {.input = arguments.input,
                                       .choices = arguments.choices,
                                       .sequence = sequence,
                                       .network = arguments.network,
                                       .options = arguments.options,
                                       .segmenter = segmenter});
  if (!arguments.quiet) {
    Print("{}\n", segmenter.Describe());
  }
  CatchInterrupts();
  const MaskFolderWork counts = SegmentAll(arguments, sequence, segmenter);
  PrintCounts(arguments, counts);
  if (IsInterrupted()) {
    PrintFailure("interrupted; the same command goes on from here");
    return kFailed;
  }
  if (counts.done == 0) {
    PrintFailure(arguments.input.string() +
                 (counts.failed > 0 ? ": the network fails on all images that can be read"
                                    : ": none of its images can be read"));
    return kBadInput;
  }
  return kDone;
}

}  // namespace hullslam

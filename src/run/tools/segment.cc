// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "files/atomic_file.h"
#include "hullslam/masks/mask_source.h"
#include "hullslam/segmentation/segmenter.h"
#include "hullslam/util/error.h"
#include "masks/yolo_text.h"
#include "run/command_line.h"
#include "run/dataset_arguments.h"
#include "run/interrupt.h"
#include "run/messages.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/segment_record.h"
#include "run/segmenter_arguments.h"
#include "run/tools/commands.h"
#include "util/counted.h"

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

struct SegmentCounts {
  size_t frames = 0;                             // that are asked for
  size_t done = 0;                               // that have a file now
  size_t made = 0;                               // by this call
  std::map<std::string, size_t> instances = {};  // by class, of this call
  std::vector<std::string> unread = {};          // faults of images without masks
  size_t failed = 0;                             // images that the network fails on
  std::string first_failure = {};
};

// Writes the masks of a frame. A frame without instances gets an empty file, so that the next call
// knows that it is done. A frame that the network fails on gets none.
void SegmentFrame(const ImageSequence& sequence, const FramePaths& frame, const fs::path& file,
                  Segmenter& segmenter, SegmentCounts& counts) {
  cv::Mat image;
  try {
    image = sequence.load_colour(frame);
  } catch (const InputError& error) {
    counts.unread.emplace_back(error.what());
    return;
  }
  std::vector<InstanceMask> masks;
  try {
    masks = segmenter.Segment(image);
  } catch (const InputError& error) {
    if (counts.failed++ == 0) {
      counts.first_failure = fmt::format("{}: {}", frame.image.filename().string(), error.what());
    }
    return;
  }
  WriteFileAtomically(file, YoloText(masks, segmenter.class_names(), image.size()));
  ++counts.made;
  ++counts.done;
  for (const InstanceMask& mask : masks) {
    ++counts.instances[mask.label];
  }
}

SegmentCounts SegmentAll(const SegmentArguments& arguments, const ImageSequence& sequence,
                         Segmenter& segmenter) {
  SegmentCounts counts;
  std::vector<std::pair<const FramePaths*, fs::path>> left;
  const std::vector<MaskFrame> names = MaskFrames(sequence);
  for (size_t i = 0; i < names.size(); i += arguments.every) {
    ++counts.frames;
    const fs::path file = arguments.output / (names[i].stem + ".txt");
    if (file.filename() == kClassNames) {
      counts.unread.push_back(
          fmt::format("{}: its masks would be in {}, which has the names of the "
                      "classes",
                      sequence.frames[i].image.string(), file.string()));
      continue;
    }
    std::error_code error;
    if (fs::exists(file, error)) {
      ++counts.done;
    } else {
      left.emplace_back(&sequence.frames[i], file);
    }
  }
  Progress progress(left.size(), arguments.quiet);
  for (size_t i = 0; i < left.size() && !IsInterrupted(); ++i) {
    SegmentFrame(sequence, *left[i].first, left[i].second, segmenter, counts);
    progress.Show(i + 1);
  }
  progress.Clear();
  return counts;
}

void PrintCounts(const SegmentArguments& arguments, const SegmentCounts& counts) {
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
  for (const std::string& warning : sequence.warnings) {
    PrintError("warning: {}\n", warning);
  }
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
  const SegmentCounts counts = SegmentAll(arguments, sequence, segmenter);
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

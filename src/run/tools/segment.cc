// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "files/atomic_file.h"
#include "files/canonical_path.h"
#include "files/json_file.h"
#include "hullslam/masks/mask_source.h"
#include "hullslam/segmentation/segmenter.h"
#include "hullslam/util/error.h"
#include "masks/yolo_text.h"
#include "results/output_folder.h"
#include "run/command_line.h"
#include "run/interrupt.h"
#include "run/messages.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/segmenter_arguments.h"
#include "run/tools/commands.h"
#include "sequences/open_images.h"
#include "util/counted.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// Beside the masks: what they were made with.
constexpr const char* kRecord = "segment.json";

struct SegmentArguments {
  fs::path input;
  fs::path network;
  fs::path output;
  SegmenterOptions options;
  OpenImagesOptions images;
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
  app.add_flag("--side-by-side", arguments.images.has_two_halves,
               "each image shows a stereo pair side by side");
  app.add_option("--image-topic", arguments.images.image_topic,
                 "topic of the images in a recording (default: found by type and name)");
  app.add_flag("--quiet", arguments.quiet, "print nothing but warnings and errors");
  AddVersionAndExitCodes(app, "done", "the program failed or was interrupted");
}

// What the masks of a folder have in common.
nlohmann::ordered_json MakeRecord(const SegmentArguments& arguments) {
  std::error_code error;
  return {{"input", CanonicalName(arguments.input)},
          {"network", arguments.network.filename().string()},
          {"bytes", fs::file_size(arguments.network, error)},
          {"min_score", arguments.options.min_score},
          {"size", arguments.options.size},
          {"classes", arguments.options.classes},
          {"names", arguments.options.names.filename().string()},
          {"boxes", arguments.options.use_boxes}};
}

// Makes the folder with the names of the classes. Refuses one with masks of other networks or
// options, because they would be mixed, and one with other files.
void PrepareFolder(const SegmentArguments& arguments, const Segmenter& segmenter) {
  const nlohmann::ordered_json record = MakeRecord(arguments);
  const fs::path file = arguments.output / kRecord;
  std::error_code error;
  fs::create_directories(arguments.output, error);
  if (!fs::is_directory(arguments.output, error)) {
    throw InputError(arguments.output.string() + ": cannot be made, expected a folder");
  }
  if (fs::exists(file, error)) {
    const nlohmann::ordered_json former = ReadJson(file);
    if (former != nlohmann::json(record)) {
      throw InputError(fmt::format(
          "{}: has masks that were made with {}, not with {}; choose another --output, or delete "
          "them",
          arguments.output.string(), former.dump(), record.dump()));
    }
  } else if (!fs::is_empty(arguments.output, error)) {
    throw InputError(arguments.output.string() +
                     ": contains files, but no masks of this command; choose another --output");
  } else {
    WriteFileAtomically(file, record.dump() + '\n');
  }
  // A former call may have been killed before it came here.
  std::string names;
  for (const std::string& name : segmenter.class_names()) {
    names += name + '\n';
  }
  WriteFileAtomically(arguments.output / "classes.txt", names);
}

struct SegmentCounts {
  size_t frames = 0;                             // that are asked for
  size_t done = 0;                               // that have a file now
  size_t made = 0;                               // by this call
  std::map<std::string, size_t> instances = {};  // by class, of this call
  std::vector<std::string> unread = {};          // faults of images
};

// Writes the masks of a frame. A frame without instances gets an empty file, so that the next call
// knows that it is done.
void SegmentFrame(const ImageSequence& sequence, const FramePaths& frame, const fs::path& file,
                  Segmenter& segmenter, SegmentCounts& counts) {
  cv::Mat image;
  try {
    image = ReadFrameColour(sequence, frame);
  } catch (const InputError& error) {
    counts.unread.emplace_back(error.what());
    return;
  }
  const std::vector<InstanceMask> masks = segmenter.Segment(image);
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
  const ImageSequence sequence = OpenImages(arguments.input, arguments.images);
  for (const std::string& warning : sequence.warnings) {
    PrintError("warning: {}\n", warning);
  }
  PrepareFolder(arguments, segmenter);
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
    PrintFailure(arguments.input.string() + ": none of its images can be read");
    return kBadInput;
  }
  return kDone;
}

}  // namespace hullslam

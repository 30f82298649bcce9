// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/tum_sequence.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "hullslam/util/stamp_pairing.h"
#include "sequences/image_list.h"
#include "sequences/named_images.h"
#include "sequences/shared_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxDifference = 0.02;  // s, as in TUM's associate.py

// Whether the images are where sequences of TUM have them.
bool HasImageFolder(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "rgb.txt", error) || fs::is_directory(folder / "rgb", error);
}

bool HasColourImages(const fs::path& folder) {
  return HasImageFolder(folder) || FindSharedFolder(folder) != nullptr;
}

// The images of a list, as frames without depth.
std::vector<FramePaths> ReadImageList(const fs::path& folder, const std::string& name,
                                      std::vector<std::string>& warnings) {
  const fs::path path = folder / name;
  ListedFrames images;
  ForEachRow(path, [&](const TextRow& row) {
    CheckColumns(row, 2, "timestamp file");
    AddFrame(row, {row.Stamp(0), ImageFile(row, 1, folder)}, images);
  });
  return TakeFrames(path, std::move(images), warnings);
}

void CheckFolder(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string() + ": no such folder, expected a sequence in TUM's format");
  }
}

// The colour or depth images of a sequence and where they are listed.
struct ImageList {
  std::vector<FramePaths> frames;
  std::string source;  // for messages
  bool is_listed = true;
  bool are_numbered = false;
  std::string data_set = {};  // if its name is known by the images' names
};

// From NAME.txt or, if the sequence has no lists, from the names of the images in the folder NAME.
// Null if there is neither.
std::optional<ImageList> FindImages(const fs::path& folder, const std::string& name,
                                    bool may_be_unlisted, const TumSequenceOptions& options,
                                    std::vector<std::string>& warnings) {
  std::error_code error;
  const std::string list = name + ".txt";
  if (fs::exists(folder / list, error)) {
    return ImageList{.frames = ReadImageList(folder, list, warnings), .source = list};
  }
  if (!may_be_unlisted) {
    return std::nullopt;
  }
  ImageList images{.frames = {}, .source = "the folder " + name, .is_listed = false};
  NamedImages named;
  if (fs::is_directory(folder / name, error)) {
    named = FindNamedImages(folder / name, options.frames_per_second);
  } else if (const SharedFolder* const shared = FindSharedFolder(folder); shared != nullptr) {
    named = FindNamedImages(folder / shared->folder, options.frames_per_second,
                            name == "rgb" ? shared->colour : shared->depth);
    images.data_set = shared->data_set;
  } else {
    return std::nullopt;
  }
  images.frames = std::move(named.frames);
  images.are_numbered = named.are_numbered;
  return images;
}

// How the time stamps were found; empty if a list has them.
std::string NoteOf(const ImageList& images, const TumSequenceOptions& options) {
  if (images.is_listed) {
    return {};
  }
  return images.are_numbered
             ? fmt::format(
                   "no rgb.txt: {}the names of the images are numbers of frames, {:g} per "
                   "second (Camera.fps)",
                   images.data_set.empty() ? "" : "a folder of " + images.data_set + ", ",
                   options.frames_per_second)
             : std::string("no rgb.txt: the names of the images are time stamps");
}

ImageList FindColourImages(const fs::path& folder, const TumSequenceOptions& options,
                           std::vector<std::string>& warnings) {
  CheckTumFolder(folder);
  return FindImages(folder, "rgb", true, options, warnings).value();
}

// Images that an association file pairs with others of quite another time say nothing about it.
double DelayOf(double image_stamp, double depth_stamp) {
  const double delay = depth_stamp - image_stamp;
  return std::abs(delay) <= kMaxDifference ? delay : 0.0;
}

ImageSequence PairImages(const fs::path& folder, const TumSequenceOptions& options) {
  ImageSequence sequence;
  ImageList colour = FindColourImages(folder, options, sequence.warnings);
  std::optional<ImageList> of_depth =
      FindImages(folder, "depth", !colour.is_listed, options, sequence.warnings);
  sequence.stamps_note = NoteOf(colour, options);
  if (!options.need_images && !of_depth) {
    sequence.unpaired = colour.frames.size();
    sequence.frames = std::move(colour.frames);
    return sequence;
  }
  if (!of_depth) {
    throw InputError(fmt::format("{}: has no depth.txt{}; without depth: mono_tum", folder.string(),
                                 colour.is_listed ? "" : " and no folder depth"));
  }
  std::vector<FramePaths>& images = colour.frames;
  std::vector<FramePaths>& depth = of_depth->frames;
  // Frames with the same number belong together, whatever the frame rate is.
  const bool by_number = colour.are_numbered && of_depth->are_numbered;
  const double max_difference = by_number ? 0.5 / options.frames_per_second : kMaxDifference;
  const std::vector<double> image_stamps = StampsOf(images);
  const std::vector<double> depth_stamps = StampsOf(depth);
  const auto pairs = PairStampsGreedily(image_stamps, depth_stamps, max_difference);
  if (pairs.empty()) {
    throw InputError(
        by_number
            ? fmt::format("{}: no image of rgb has the number of one of depth", folder.string())
            : fmt::format(
                  "{}: no image of {} has one of {} within {} s, the smallest gap is {:.6f} s",
                  folder.string(), colour.source, of_depth->source, max_difference,
                  SmallestGap(image_stamps, depth_stamps)));
  }
  sequence.unpaired = images.size() - pairs.size();
  for (const auto& [i, j] : pairs) {
    images[i].depth = std::move(depth[j].image);
    images[i].depth_delay = by_number ? 0.0 : DelayOf(images[i].timestamp, depth[j].timestamp);
    sequence.frames.push_back(std::move(images[i]));
  }
  return sequence;
}

ImageSequence ReadColourImages(const fs::path& folder, const TumSequenceOptions& options) {
  ImageSequence sequence;
  ImageList images = FindColourImages(folder, options, sequence.warnings);
  sequence.stamps_note = NoteOf(images, options);
  sequence.frames = std::move(images.frames);
  return sequence;
}

ImageSequence ReadAssociations(const fs::path& folder, const fs::path& path) {
  ImageSequence sequence;
  ListedFrames list;
  ForEachRow(path, [&](const TextRow& row) {
    CheckColumns(row, 4, "timestamp rgb timestamp depth");
    const double stamp = row.Stamp(0, "timestamp of rgb");
    AddFrame(row,
             {.timestamp = stamp,
              .image = ImageFile(row, 1, folder),
              .depth = ImageFile(row, 3, folder),
              .depth_delay = DelayOf(stamp, row.Stamp(2, "timestamp of depth"))},
             list);
  });
  sequence.frames = TakeFrames(path, std::move(list), sequence.warnings);
  return sequence;
}

ImageSequence ReadLists(const fs::path& folder, const TumSequenceOptions& options) {
  if (options.associations.empty()) {
    return options.use_depth ? PairImages(folder, options) : ReadColourImages(folder, options);
  }
  ImageSequence sequence = ReadAssociations(folder, options.associations);
  if (!options.use_depth) {
    for (FramePaths& frame : sequence.frames) {
      frame.depth.clear();
    }
  }
  return sequence;
}

// groundtruth.txt, or the poses of a data set that is known by the names of its images.
void AddGroundtruth(const fs::path& folder, const TumSequenceOptions& options,
                    ImageSequence& sequence) {
  std::error_code error;
  const fs::path groundtruth = folder / "groundtruth.txt";
  if (fs::exists(groundtruth, error)) {
    sequence.groundtruth = groundtruth;
  } else if (const SharedFolder* const shared = FindSharedFolder(folder);
             shared != nullptr && options.associations.empty() && !HasImageFolder(folder)) {
    sequence.converted_groundtruth = ReadSharedPoses(*shared, folder, sequence.frames,
                                                     options.frames_per_second, sequence.warnings);
  }
}

void DropMissingDepth(std::vector<FramePaths>& frames) {
  std::error_code error;
  for (FramePaths& frame : frames) {
    if (!fs::is_regular_file(frame.depth, error)) {
      frame.depth.clear();
    }
  }
}

}  // namespace

void CheckTumFolder(const fs::path& folder) {
  CheckFolder(folder);
  if (!HasColourImages(folder)) {
    throw InputError(fmt::format(
        "{}: has neither rgb.txt nor a folder rgb, nor images named as in 7-Scenes or Replica; "
        "expected a sequence in TUM's format{}",
        folder.string(), SuggestFolder(folder, HasColourImages)));
  }
}

ImageSequence OpenTumSequence(const fs::path& folder, const TumSequenceOptions& options) {
  CheckFolder(folder);
  ImageSequence sequence = ReadLists(folder, options);
  sequence.dataset = "tum";
  SelectFrames(folder, options.selection, sequence);
  if (options.need_images) {
    LeaveOutMissing(sequence);
  } else {
    DropMissingDepth(sequence.frames);
  }
  AddGroundtruth(folder, options, sequence);
  return sequence;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/tum_sequence.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "hullslam/util/stamp_pairing.h"
#include "sequences/image_list.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxDifference = 0.02;  // s, as in TUM's associate.py

// The images of a list, as frames without depth.
std::vector<FramePaths> ReadImageList(const fs::path& folder, const char* name) {
  const fs::path path = folder / name;
  std::vector<FramePaths> images;
  ForEachRow(path, [&](const TextRow& row) {
    CheckColumns(row, 2, "timestamp file");
    AddFrame(row, {row.Stamp(0), ImageFile(row, 1, folder)}, images);
  });
  if (images.empty()) {
    throw InputError(path.string() + ": has no images");
  }
  return images;
}

std::vector<double> StampsOf(const std::vector<FramePaths>& images) {
  std::vector<double> stamps;
  for (const FramePaths& image : images) {
    stamps.push_back(image.timestamp);
  }
  return stamps;
}

ImageSequence PairLists(const fs::path& folder, bool need_depth) {
  ImageSequence sequence;
  std::vector<FramePaths> images = ReadImageList(folder, "rgb.txt");
  std::error_code error;
  if (!need_depth && !fs::exists(folder / "depth.txt", error)) {
    sequence.unpaired = images.size();
    sequence.frames = std::move(images);
    return sequence;
  }
  std::vector<FramePaths> depth = ReadImageList(folder, "depth.txt");
  const std::vector<double> of_images = StampsOf(images);
  const std::vector<double> of_depth = StampsOf(depth);
  const auto pairs = PairStampsGreedily(of_images, of_depth, kMaxDifference);
  if (pairs.empty()) {
    throw InputError(fmt::format(
        "{}: no image of rgb.txt has one of depth.txt within {} s, the smallest gap is {:.6f} s",
        folder.string(), kMaxDifference, SmallestGap(of_images, of_depth)));
  }
  sequence.unpaired = images.size() - pairs.size();
  for (const auto& [i, j] : pairs) {
    images[i].depth = std::move(depth[j].image);
    sequence.frames.push_back(std::move(images[i]));
  }
  return sequence;
}

ImageSequence ReadColourList(const fs::path& folder) {
  ImageSequence sequence;
  sequence.frames = ReadImageList(folder, "rgb.txt");
  return sequence;
}

ImageSequence ReadAssociations(const fs::path& folder, const fs::path& path) {
  ImageSequence sequence;
  ForEachRow(path, [&](const TextRow& row) {
    CheckColumns(row, 4, "timestamp rgb timestamp depth");
    row.Stamp(2, "timestamp of depth");
    AddFrame(
        row,
        {row.Stamp(0, "timestamp of rgb"), ImageFile(row, 1, folder), ImageFile(row, 3, folder)},
        sequence.frames);
  });
  if (sequence.frames.empty()) {
    throw InputError(path.string() + ": has no images");
  }
  return sequence;
}

ImageSequence ReadLists(const fs::path& folder, const TumSequenceOptions& options) {
  if (options.associations.empty()) {
    return options.use_depth ? PairLists(folder, options.need_images) : ReadColourList(folder);
  }
  ImageSequence sequence = ReadAssociations(folder, options.associations);
  if (!options.use_depth) {
    for (FramePaths& frame : sequence.frames) {
      frame.depth.clear();
    }
  }
  return sequence;
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

ImageSequence OpenTumSequence(const fs::path& folder, const TumSequenceOptions& options) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string() + ": no such folder, expected a sequence in TUM's format");
  }
  ImageSequence sequence = ReadLists(folder, options);
  SelectFrames(folder, options.selection, sequence);
  if (options.need_images) {
    CheckImagesExist(sequence.frames);
  } else {
    DropMissingDepth(sequence.frames);
  }
  const fs::path groundtruth = folder / "groundtruth.txt";
  if (fs::exists(groundtruth, error)) {
    sequence.groundtruth = groundtruth;
  }
  return sequence;
}

}  // namespace hullslam

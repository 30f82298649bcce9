// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/tum_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

#include "hullslam/io/image_file.h"
#include "hullslam/util/error.h"
#include "hullslam/util/stamp_pairing.h"
#include "io/text_rows.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxDifference = 0.02;  // s, as in TUM's associate.py

struct ImageList {
  std::vector<double> stamps;
  std::vector<fs::path> files;
};

void CheckColumns(const TextRow& row, size_t count, const char* names) {
  if (row.columns.size() < count) {
    row.Fail(fmt::format("{} column(s), expected {}: {}", row.columns.size(), count, names));
  }
}

// The file of an image, which the list in `folder` names in a column.
fs::path ImageFile(const TextRow& row, size_t column, const fs::path& folder) {
  constexpr size_t kLongest = 1000;
  if (row.columns[column].size() > kLongest) {
    row.Fail(fmt::format("the name of the file has {} bytes, expected at most {}",
                         row.columns[column].size(), kLongest));
  }
  return folder / row.columns[column];
}

void CheckCount(const TextRow& row, size_t count) {
  constexpr size_t kMostImages = 1'000'000;
  if (count > kMostImages) {
    row.Fail(fmt::format("more than {} images", kMostImages));
  }
}

void CheckIncreasing(const TextRow& row, double stamp, const double* former) {
  if (former != nullptr && stamp <= *former) {
    row.Fail(fmt::format("time stamp {:.6f} does not come after the previous one, {:.6f}", stamp,
                         *former));
  }
}

ImageList ReadImageList(const fs::path& folder, const char* name) {
  const fs::path path = folder / name;
  ImageList list;
  ForEachRow(path, [&](const TextRow& row) {
    CheckColumns(row, 2, "timestamp file");
    const double stamp = row.Stamp(0);
    CheckIncreasing(row, stamp, list.stamps.empty() ? nullptr : &list.stamps.back());
    list.stamps.push_back(stamp);
    list.files.push_back(ImageFile(row, 1, folder));
    CheckCount(row, list.files.size());
  });
  if (list.stamps.empty()) {
    throw InputError(path.string() + ": has no images");
  }
  return list;
}

// The frames if only the colour images are used.
TumSequence ReadColourList(const fs::path& folder) {
  const ImageList rgb = ReadImageList(folder, "rgb.txt");
  TumSequence sequence;
  sequence.unpaired = rgb.stamps.size();
  for (size_t i = 0; i < rgb.stamps.size(); ++i) {
    sequence.frames.push_back({rgb.stamps[i], rgb.files[i], fs::path(), i});
  }
  return sequence;
}

TumSequence PairLists(const fs::path& folder, bool need_depth) {
  std::error_code error;
  if (!need_depth && !fs::exists(folder / "depth.txt", error)) {
    return ReadColourList(folder);
  }
  ImageList rgb = ReadImageList(folder, "rgb.txt");
  ImageList depth = ReadImageList(folder, "depth.txt");
  const auto pairs = PairStampsGreedily(rgb.stamps, depth.stamps, kMaxDifference);
  if (pairs.empty()) {
    throw InputError(fmt::format(
        "{}: no image of rgb.txt has one of depth.txt within {} s, the smallest gap is {:.6f} s",
        folder.string(), kMaxDifference, SmallestGap(rgb.stamps, depth.stamps)));
  }
  TumSequence sequence;
  sequence.unpaired = rgb.stamps.size() - pairs.size();
  for (const auto& [i, j] : pairs) {
    sequence.frames.push_back(
        {rgb.stamps[i], std::move(rgb.files[i]), std::move(depth.files[j]), i});
  }
  return sequence;
}

TumSequence ReadAssociations(const fs::path& folder, const fs::path& path) {
  TumSequence sequence;
  ForEachRow(path, [&](const TextRow& row) {
    CheckColumns(row, 4, "timestamp rgb timestamp depth");
    RgbdFramePaths frame{row.Stamp(0, "timestamp of rgb"), ImageFile(row, 1, folder),
                         ImageFile(row, 3, folder), sequence.frames.size()};
    row.Stamp(2, "timestamp of depth");
    CheckIncreasing(row, frame.timestamp,
                    sequence.frames.empty() ? nullptr : &sequence.frames.back().timestamp);
    sequence.frames.push_back(std::move(frame));
    CheckCount(row, sequence.frames.size());
  });
  if (sequence.frames.empty()) {
    throw InputError(path.string() + ": has no images");
  }
  return sequence;
}

std::vector<RgbdFramePaths> Select(const fs::path& folder, std::vector<RgbdFramePaths> frames,
                                   const FrameSelection& selection) {
  if (selection.stride == 0) {
    throw InputError("--stride is '0', expected an integer >= 1");
  }
  if (selection.first > selection.last) {
    throw InputError(fmt::format("--first is '{}', expected at most --last, '{}'", selection.first,
                                 selection.last));
  }
  if (selection.first >= frames.size()) {
    throw InputError(fmt::format("--first is '{}', expected less than the {} frames of {}",
                                 selection.first, frames.size(), folder.string()));
  }
  std::vector<RgbdFramePaths> selected;
  const size_t last = std::min(selection.last, frames.size() - 1);
  for (size_t i = selection.first;; i += selection.stride) {
    selected.push_back(std::move(frames[i]));
    if (selection.stride > last - i) {
      return selected;
    }
  }
}

void CheckImagesExist(const std::vector<RgbdFramePaths>& frames) {
  std::error_code error;
  for (const RgbdFramePaths& frame : frames) {
    for (const fs::path& image : {frame.rgb, frame.depth}) {
      if (!fs::is_regular_file(image, error)) {
        throw InputError(image.string() + ": the image is missing");
      }
    }
  }
}

void DropMissingDepth(std::vector<RgbdFramePaths>& frames) {
  std::error_code error;
  for (RgbdFramePaths& frame : frames) {
    if (!fs::is_regular_file(frame.depth, error)) {
      frame.depth.clear();
    }
  }
}

void CheckSize(const fs::path& path, const cv::Mat& image, const PinholeCamera& camera) {
  if (image.cols != camera.width || image.rows != camera.height) {
    throw InputError(fmt::format("{}: {}x{} px, expected Camera.width x Camera.height, {}x{}",
                                 path.string(), image.cols, image.rows, camera.width,
                                 camera.height));
  }
}

}  // namespace

TumSequence OpenTumSequence(const fs::path& folder, const TumSequenceOptions& options) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string() + ": no such folder, expected a sequence in TUM's format");
  }
  TumSequence sequence = options.associations.empty()
                             ? PairLists(folder, options.need_images)
                             : ReadAssociations(folder, options.associations);
  sequence.available = sequence.frames.size();
  sequence.frames = Select(folder, std::move(sequence.frames), options.selection);
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

ImageInput LoadRgbd(const RgbdFramePaths& paths, const PinholeCamera& camera) {
  ImageInput image{paths.timestamp, ReadGreyImage(paths.rgb), ReadDepthImage(paths.depth)};
  if (image.grey.size() != image.depth.size()) {
    throw InputError(fmt::format("{}: {}x{} px, expected the size of its colour image {}, {}x{}",
                                 paths.depth.string(), image.depth.cols, image.depth.rows,
                                 paths.rgb.filename().string(), image.grey.cols, image.grey.rows));
  }
  CheckSize(paths.rgb, image.grey, camera);
  return image;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/image_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// At most one of so many rows of a list may be unusable. More are no accident, but another list.
constexpr size_t kFewOf = 10;

// The first file of a frame that does not exist; empty if all do.
fs::path MissingImage(const FramePaths& frame) {
  std::error_code error;
  for (const fs::path& image : {frame.image, frame.depth, frame.right}) {
    const bool is_not_wanted = image.empty() && !frame.image.empty();
    if (!is_not_wanted && !fs::is_regular_file(image, error)) {
      return image;
    }
  }
  return {};
}

std::vector<FramePaths> Select(const fs::path& source, std::vector<FramePaths> frames,
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
                                 selection.first, frames.size(), source.string()));
  }
  std::vector<FramePaths> selected;
  const size_t last = std::min(selection.last, frames.size() - 1);
  for (size_t i = selection.first;; i += selection.stride) {
    selected.push_back(std::move(frames[i]));
    if (selection.stride > last - i) {
      return selected;
    }
  }
}

}  // namespace

void CheckColumns(const TextRow& row, size_t count, const char* names) {
  if (row.columns.size() < count) {
    row.Fail(fmt::format("{} column(s), expected {}: {}", row.columns.size(), count, names));
  }
}

fs::path ImageFile(const TextRow& row, size_t column, const fs::path& folder) {
  constexpr size_t kLongest = 1000;
  if (row.columns[column].size() > kLongest) {
    row.Fail(fmt::format("the name of the file has {} bytes, expected at most {}",
                         row.columns[column].size(), kLongest));
  }
  // Programs on Windows write rgb\1.png.
  std::string name(row.columns[column]);
  std::replace(name.begin(), name.end(), '\\', '/');
  return folder / name;
}

bool AddFrame(const TextRow& row, FramePaths frame, ListedFrames& list) {
  ++list.rows;
  if (list.rows > kMostImages) {
    row.Fail(fmt::format("more than {} images", kMostImages));
  }
  if (!list.frames.empty() && frame.timestamp <= list.frames.back().timestamp) {
    const double former = list.frames.back().timestamp;
    if (list.repeated + list.earlier == 0) {
      list.fault =
          fmt::format("{}:{}: time stamp {:.6f} does not come after the previous one, {:.6f}",
                      row.path.string(), row.line, frame.timestamp, former);
    }
    ++(frame.timestamp == former ? list.repeated : list.earlier);
    return false;
  }
  frame.number = list.frames.size();
  list.frames.push_back(std::move(frame));
  return true;
}

std::vector<FramePaths> TakeFrames(const fs::path& path, ListedFrames list,
                                   std::vector<std::string>& warnings) {
  if (list.frames.empty()) {
    throw InputError(path.string() + ": has no images");
  }
  if (kFewOf * list.earlier > list.rows) {
    throw InputError(list.fault);
  }
  if (const size_t unused = list.repeated + list.earlier; unused > 0) {
    warnings.push_back(fmt::format("{}; {} of the {} images are not used for this", list.fault,
                                   unused, list.rows));
  }
  return std::move(list.frames);
}

double MeanRate(const std::vector<FramePaths>& frames, double fallback) {
  const double time = frames.empty() ? 0.0 : frames.back().timestamp - frames.front().timestamp;
  return time > 0.0 ? static_cast<double>(frames.size() - 1) / time : fallback;
}

void SelectFrames(const fs::path& source, const FrameSelection& selection,
                  ImageSequence& sequence) {
  sequence.available = sequence.frames.size();
  sequence.frames = Select(source, std::move(sequence.frames), selection);
}

std::vector<fs::path> ListFolder(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    paths.push_back(entry->path());
  }
  if (error) {
    throw InputError(folder.string() + ": " + error.message());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string SuggestFolder(const fs::path& folder,
                          const std::function<bool(const fs::path&)>& is_sequence) {
  std::error_code error;
  const fs::path here = fs::weakly_canonical(fs::absolute(folder, error), error);
  std::vector<fs::path> found;
  if (is_sequence(here.parent_path())) {
    found.push_back(here.parent_path());
  }
  for (fs::directory_iterator entry(here, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored) && is_sequence(entry->path())) {
      found.push_back(entry->path());
    }
  }
  return found.size() == 1 ? fmt::format("; did you mean {}?", found.front().string())
                           : std::string();
}

void CheckImagesExist(const std::vector<FramePaths>& frames) {
  for (const FramePaths& frame : frames) {
    if (const fs::path missing = MissingImage(frame); !missing.empty()) {
      throw InputError(missing.string() + ": the image is missing");
    }
  }
}

void LeaveOutMissing(ImageSequence& sequence) {
  std::vector<FramePaths> found;
  fs::path first;
  for (const FramePaths& frame : sequence.frames) {
    const fs::path missing = MissingImage(frame);
    if (missing.empty()) {
      found.push_back(frame);
    } else if (first.empty()) {
      first = missing;
    }
  }
  const size_t left_out = sequence.frames.size() - found.size();
  if (kFewOf * left_out > sequence.frames.size()) {
    throw InputError(first.string() + ": the image is missing");
  }
  if (left_out > 0) {
    sequence.warnings.push_back(
        fmt::format("{}: the image is missing; {} of the {} frames are left out for this",
                    first.string(), left_out, sequence.frames.size()));
    sequence.frames = std::move(found);
  }
}

void CheckImageSize(const std::string& name, const cv::Mat& image, const PinholeCamera& camera) {
  if (image.cols != camera.width || image.rows != camera.height) {
    throw InputError(fmt::format("{}: {}x{} px, expected Camera.width x Camera.height, {}x{}", name,
                                 image.cols, image.rows, camera.width, camera.height));
  }
}

const FramePaths* FindFrameAt(const ImageSequence& sequence, double timestamp) {
  const auto difference = [timestamp](const FramePaths& frame) {
    return std::abs(frame.timestamp - timestamp);
  };
  const auto nearest = std::ranges::min_element(sequence.frames, {}, difference);
  return nearest != sequence.frames.end() && difference(*nearest) <= kSameMoment ? &*nearest
                                                                                 : nullptr;
}

cv::Mat LoadColour(const ImageSequence& sequence, const FramePaths& frame,
                   const PinholeCamera& camera) {
  cv::Mat image = sequence.load_colour(frame);
  CheckImageSize(frame.image.string(), image, camera);
  return image;
}

}  // namespace hullslam

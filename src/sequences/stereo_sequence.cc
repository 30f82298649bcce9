// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/stereo_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/sequences/image_stream.h"
#include "hullslam/util/error.h"
#include "sequences/image_file.h"
#include "sequences/image_list.h"
#include "sequences/named_images.h"
#include "sequences/stereo_loading.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// ---- KITTI

// A row "P0: 12 numbers" of a calib.txt: a 3x4 projection of rectified images, by rows. The fourth
// column is the focal length times the position of the camera to the left of camera 0.
using Projection = std::array<double, 12>;

std::map<std::string, Projection> ReadProjections(const fs::path& file) {
  constexpr double kMost = 1e6;
  std::map<std::string, Projection> projections;
  ForEachRow(file, [&](const TextRow& row) {
    const std::string_view name = row.columns.front();
    if (!name.starts_with('P') || !name.ends_with(':')) {
      return;  // the transform to the laser scanner, for example
    }
    CheckColumns(row, 13, "name and the 12 numbers of a projection");
    Projection projection;
    for (size_t i = 0; i < projection.size(); ++i) {
      projection[i] = row.Number(i + 1, "number of a projection", kMost);
    }
    projections[std::string(name.substr(0, name.size() - 1))] = projection;
  });
  return projections;
}

PinholeCamera LeftCameraOf(const Projection& p) {
  return {.fx = p[0], .fy = p[5], .cx = p[2], .cy = p[6]};
}

PinholeCamera CameraOf(const fs::path& file, const std::string& name) {
  const std::map<std::string, Projection> projections = ReadProjections(file);
  const auto found = projections.find(name);
  if (found == projections.end()) {
    throw InputError(
        fmt::format("{}: has no row '{}:', expected a calib.txt of KITTI", file.string(), name));
  }
  return LeftCameraOf(found->second);
}

PinholeCamera CameraOfPair(const fs::path& file, const std::string& left_name,
                           const std::string& right_name) {
  const std::map<std::string, Projection> projections = ReadProjections(file);
  const auto left = projections.find(left_name);
  const auto right = projections.find(right_name);
  if (left == projections.end() || right == projections.end()) {
    throw InputError(fmt::format("{}: has no rows '{}:' and '{}:', expected a calib.txt of KITTI",
                                 file.string(), left_name, right_name));
  }
  PinholeCamera camera = LeftCameraOf(left->second);
  camera.bf = left->second[3] - right->second[3];
  if (!(camera.bf > 0.0)) {
    throw InputError(fmt::format(
        "{}: camera {} is {:g} m to the right of camera {}, expected more than 0: left and right "
        "are swapped, or are the same",
        file.string(), right_name, camera.fx != 0.0 ? camera.bf / camera.fx : 0.0, left_name));
  }
  return camera;
}

std::vector<double> ReadTimes(const fs::path& file) {
  std::vector<double> times;
  ForEachRow(file, [&](const TextRow& row) { times.push_back(row.Stamp(0)); });
  return times;
}

// `right` is the folder of the right images; empty for the left ones alone.
std::vector<FramePaths> ListKittiImages(const fs::path& folder, const fs::path& left,
                                        const fs::path& right, std::vector<std::string>& warnings) {
  const fs::path times_file = folder / "times.txt";
  const std::vector<double> times = ReadTimes(times_file);
  const std::vector<fs::path> images = ListImages(left);
  if (images.size() != times.size()) {
    throw InputError(fmt::format("{}: has {} times, expected one for each of the {} images in {}",
                                 times_file.string(), times.size(), images.size(), left.string()));
  }
  ListedFrames list;
  for (size_t i = 0; i < images.size(); ++i) {
    FramePaths frame{times[i], images[i]};
    if (!right.empty()) {
      frame.right = right / images[i].filename();
    }
    const TextRow row{times_file, static_cast<int>(i) + 1, {}};
    AddFrame(row, std::move(frame), list);
  }
  return TakeFrames(times_file, std::move(list), warnings);
}

std::optional<fs::path> FindKittiTruth(const fs::path& folder) {
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(folder, error);
  const fs::path name = absolute.filename().string() + ".txt";
  for (const fs::path& file :
       {folder / "groundtruth.txt", folder / "poses.txt",
        absolute.parent_path().parent_path() / "poses" / name, absolute.parent_path() / name}) {
    if (fs::is_regular_file(file, error)) {
      return file;
    }
  }
  return std::nullopt;
}

// The first two of the folders that exist: grey or colour images.
std::pair<std::string, std::string> FindKittiFolders(const fs::path& folder) {
  std::error_code error;
  for (const auto& [left, right] : {std::pair("0", "1"), std::pair("2", "3")}) {
    if (fs::is_directory(folder / (std::string("image_") + left), error)) {
      return {left, right};
    }
  }
  const auto is_sequence = [&](const fs::path& other) {
    return fs::is_directory(other / "image_0", error) || fs::is_directory(other / "image_2", error);
  };
  throw InputError(folder.string() +
                   ": has no folder image_0 or image_2, expected a sequence of KITTI's odometry "
                   "benchmark" +
                   SuggestFolder(folder, is_sequence));
}

void SetSize(const fs::path& image, PinholeCamera& camera) {
  const cv::Mat first = ReadGreyImage(image);
  camera.width = first.cols;
  camera.height = first.rows;
}

// The steps after the frames were listed and the intrinsics were read.
void FinishKitti(const fs::path& folder, const FrameSelection& selection, ImageSequence& images,
                 CameraCalibration& calibration) {
  constexpr double kRate = 10.0;  // KITTI's
  calibration.frames_per_second = MeanRate(images.frames, kRate);
  SetSize(images.frames.front().image, calibration.camera);
  images.groundtruth = FindKittiTruth(folder);
  SelectFrames(folder, selection, images);
  LeaveOutMissing(images);
}

// ---- folders

// What a name shares with that of its partner: the whole name, or only its last number where the
// names also tell the side ("left_000010" and "right_000010").
enum class SharedPart { kName, kNumber };

std::string PartOf(const fs::path& image, SharedPart shared) {
  const std::string stem = image.stem().string();
  if (shared == SharedPart::kName) {
    return stem;
  }
  const std::string_view number = LastNumber(stem);
  const size_t zeros = std::min(number.find_first_not_of('0'), number.size());
  return std::string(number.substr(zeros));
}

// The right images by what they share with left ones; nothing if two of them share the same.
std::optional<std::map<std::string, fs::path>> ByPart(const std::vector<fs::path>& images,
                                                      SharedPart shared) {
  std::map<std::string, fs::path> by_part;
  for (const fs::path& image : images) {
    by_part[PartOf(image, shared)] = image;
  }
  return by_part.size() == images.size() ? std::optional(std::move(by_part)) : std::nullopt;
}

// The left images that have a partner.
std::vector<FramePaths> PairBy(SharedPart shared, const std::vector<FramePaths>& left,
                               const std::vector<fs::path>& right) {
  const auto by_part = ByPart(right, shared);
  std::vector<FramePaths> pairs;
  for (const FramePaths& frame : left) {
    if (!by_part) {
      break;
    }
    if (const auto partner = by_part->find(PartOf(frame.image, shared));
        partner != by_part->end()) {
      pairs.push_back(frame);
      pairs.back().right = partner->second;
      pairs.back().number = pairs.size() - 1;
    }
  }
  return pairs;
}

// Pairs the images of two folders by what their names share, and leaves out those without a
// partner. Only where names share nothing, equally many images are pairs in the order of their
// names.
void PairFolders(const fs::path& left_folder, const fs::path& right_folder,
                 double frames_per_second, ImageSequence& sequence) {
  const std::vector<FramePaths> left = FindNamedImages(left_folder, frames_per_second).frames;
  const std::vector<fs::path> right = ListImages(right_folder);
  std::vector<FramePaths>& pairs = sequence.frames;
  pairs = PairBy(SharedPart::kName, left, right);
  if (pairs.empty()) {
    pairs = PairBy(SharedPart::kNumber, left, right);
  }
  if (pairs.empty() && left.size() == right.size()) {
    pairs = left;
    for (size_t i = 0; i < pairs.size(); ++i) {
      pairs[i].right = right[i];
    }
  }
  if (2 * pairs.size() < left.size()) {
    throw InputError(fmt::format(
        "{} has {} images, and {} of them have a partner among the {} of {}, expected pairs with "
        "the same names or numbers",
        left_folder.string(), left.size(), pairs.size(), right.size(), right_folder.string()));
  }
  sequence.unpaired = left.size() - pairs.size();
  if (pairs.size() < left.size() || pairs.size() < right.size()) {
    sequence.warnings.push_back(
        fmt::format("{} of {} images of {} and {} of {} of {} have no partner and are left out",
                    sequence.unpaired, left.size(), left_folder.string(),
                    right.size() - pairs.size(), right.size(), right_folder.string()));
  }
}

}  // namespace

StereoSequence OpenKittiPairs(const fs::path& folder, const FrameSelection& selection,
                              const std::shared_ptr<const StereoRectifier>& rectifier) {
  const auto [left, right] = FindKittiFolders(folder);
  StereoSequence sequence;
  sequence.images.dataset = "kitti";
  if (rectifier == nullptr) {
    sequence.calibration.camera = CameraOfPair(folder / "calib.txt", "P" + left, "P" + right);
  }
  sequence.images.frames = ListKittiImages(folder, folder / ("image_" + left),
                                           folder / ("image_" + right), sequence.images.warnings);
  FinishKitti(folder, selection, sequence.images, sequence.calibration);
  if (rectifier != nullptr) {
    sequence.calibration.camera = rectifier->camera();
  }
  LoadPairs(rectifier, sequence.images);
  return sequence;
}

LeftSequence OpenKittiImages(const fs::path& folder, const FrameSelection& selection) {
  const std::string left = FindKittiFolders(folder).first;
  LeftSequence sequence;
  sequence.images.dataset = "kitti_left";
  sequence.calibration.camera = CameraOf(folder / "calib.txt", "P" + left);
  sequence.images.frames =
      ListKittiImages(folder, folder / ("image_" + left), {}, sequence.images.warnings);
  FinishKitti(folder, selection, sequence.images, sequence.calibration);
  return sequence;
}

ImageSequence OpenStereoFolder(const fs::path& path, const StereoFolderOptions& options) {
  std::error_code error;
  // make_synthetic writes the left images where its RGB-D sequences have them.
  const fs::path left = fs::is_directory(path / "left", error) ? path / "left" : path / "rgb";
  const bool has_left = fs::is_directory(left, error);
  const bool has_right = fs::is_directory(path / "right", error);
  if (has_left != has_right) {
    throw InputError(fmt::format("{}: has a folder {} but none {}, expected both", path.string(),
                                 has_left ? "left" : "right", has_left ? "right" : "left"));
  }
  if (!has_left) {
    ImageSequence halves =
        OpenImageStream(path, {.frames_per_second = fs::is_directory(path, error)
                                                        ? std::optional(options.frames_per_second)
                                                        : std::nullopt,
                               .selection = options.selection})
            .images;
    SplitHalves(options.rectifier, halves);
    halves.dataset = "stereo_folder";
    return halves;
  }
  ImageSequence sequence;
  sequence.dataset = "stereo_folder";
  PairFolders(left, path / "right", options.frames_per_second, sequence);
  if (fs::is_regular_file(path / "groundtruth.txt", error)) {
    sequence.groundtruth = path / "groundtruth.txt";
  }
  SelectFrames(path, options.selection, sequence);
  LoadPairs(options.rectifier, sequence);
  return sequence;
}

}  // namespace hullslam

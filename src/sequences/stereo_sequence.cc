// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/stereo_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "files/read_file.h"
#include "files/text_rows.h"
#include "hullslam/sequences/image_stream.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"
#include "sequences/image_list.h"
#include "sequences/named_images.h"
#include "sequences/stereo_pairing.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// ---- KITTI

// A row "P0: 12 numbers" of the odometry benchmark, or "P_rect_00:" of the raw data: a 3x4
// projection of rectified images, by rows. The fourth column is the focal length times the position
// of the camera to the left of camera 0.
using Projection = std::array<double, 12>;

// The projections by the digit of the camera.
std::map<char, Projection> ReadProjections(const fs::path& file) {
  constexpr double kMost = 1e6;
  std::map<char, Projection> projections;
  ForEachRow(file, [&](const TextRow& row) {
    const std::string_view name = row.columns.front();
    if (!name.starts_with('P') || !name.ends_with(':') || name.size() < 3) {
      return;  // the transform to the laser scanner, for example
    }
    CheckColumns(row, 13, "name and the 12 numbers of a projection");
    Projection projection;
    for (size_t i = 0; i < projection.size(); ++i) {
      projection[i] = row.Number(i + 1, "number of a projection", kMost);
    }
    projections[name[name.size() - 2]] = projection;
  });
  return projections;
}

PinholeCamera LeftCameraOf(const Projection& p) {
  return {.fx = p[0], .fy = p[5], .cx = p[2], .cy = p[6]};
}

const Projection& ProjectionOf(const fs::path& file, const std::map<char, Projection>& projections,
                               char camera) {
  const auto found = projections.find(camera);
  if (found == projections.end()) {
    throw InputError(fmt::format(
        "{}: has neither a row 'P{}:' nor 'P_rect_0{}:', expected a calibration of KITTI",
        file.string(), camera, camera));
  }
  return found->second;
}

PinholeCamera CameraOf(const fs::path& file, char camera) {
  return LeftCameraOf(ProjectionOf(file, ReadProjections(file), camera));
}

PinholeCamera CameraOfPair(const fs::path& file, char left_camera, char right_camera) {
  const std::map<char, Projection> projections = ReadProjections(file);
  const Projection& left = ProjectionOf(file, projections, left_camera);
  const Projection& right = ProjectionOf(file, projections, right_camera);
  PinholeCamera camera = LeftCameraOf(left);
  camera.bf = left[3] - right[3];
  if (!(camera.bf > 0.0)) {
    throw InputError(fmt::format(
        "{}: camera P{} is {:g} m to the right of camera P{}, expected more than 0: left and right "
        "are swapped, or are the same",
        file.string(), right_camera, camera.fx != 0.0 ? camera.bf / camera.fx : 0.0, left_camera));
  }
  return camera;
}

// The seconds since 1970 of a row such as "2011-09-26 13:02:25.964389445".
double SecondsOfDate(const TextRow& row) {
  const auto fail = [&row] {
    row.Fail("expected a date and a time, such as 2011-09-26 13:02:25.5");
  };
  // The three numbers of a text that are separated by `separator`.
  const auto split = [&](std::string_view text, char separator) {
    std::array<double, 3> numbers{};
    for (size_t i = 0; i < numbers.size(); ++i) {
      const size_t end = i + 1 < numbers.size() ? text.find(separator) : text.size();
      if (end == std::string_view::npos || !ParseFinite(text.substr(0, end), numbers[i])) {
        fail();
      }
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    return numbers;
  };
  const auto [year, month, day] = split(row.columns[0], '-');
  const auto [hours, minutes, seconds] = split(row.columns[1], ':');
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(year)),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) {
    fail();
  }
  const std::chrono::duration<double> midnight = std::chrono::sys_days(date).time_since_epoch();
  constexpr double kMinute = 60.0;
  return midnight.count() + kMinute * (kMinute * hours + minutes) + seconds;
}

std::vector<double> ReadTimes(const fs::path& file) {
  std::vector<double> times;
  ForEachRow(file, [&](const TextRow& row) { times.push_back(row.Stamp(0)); });
  return times;
}

// The times of KITTI's raw data. ForEachRow() would take the first date for the names of columns.
std::vector<double> ReadDates(const fs::path& file) {
  const std::string text = ReadText(file);
  std::vector<double> times;
  int line = 0;
  for (std::string_view words : LinesOf(text)) {
    ++line;
    words = words.substr(0, words.find_last_not_of(" \r") + 1);
    if (!words.empty()) {
      const size_t blank = std::min(words.find(' '), words.size() - 1);
      times.push_back(
          SecondsOfDate({file, line, {words.substr(0, blank), words.substr(blank + 1)}}));
    }
  }
  return times;
}

constexpr const char* kRawTimes = "timestamps.txt";

// Where the files of a sequence are.
struct KittiFiles {
  fs::path left;
  fs::path right;
  fs::path times;
  fs::path calibration;
  char left_camera;  // its digit
  char right_camera;
};

// `right` is the folder of the right images; empty for the left ones alone.
std::vector<FramePaths> ListKittiImages(const fs::path& times_file, const fs::path& left,
                                        const fs::path& right, std::vector<std::string>& warnings) {
  const std::vector<double> times =
      times_file.filename() == kRawTimes ? ReadDates(times_file) : ReadTimes(times_file);
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

// The first file that exists; the last one if none does.
fs::path FirstThere(std::initializer_list<fs::path> files) {
  std::error_code error;
  const auto* const found = std::find_if(
      files.begin(), files.end(), [&](const fs::path& file) { return fs::exists(file, error); });
  return found == files.end() ? *std::prev(files.end()) : *found;
}

// The first of the folders that exist: grey or colour images of the odometry benchmark or of the
// raw data. The calibration of the raw data is beside the folders of the drives of a day, or was
// copied into one. Some people have the images of one in the folders of the other.
std::optional<KittiFiles> FindIn(const fs::path& folder) {
  std::error_code error;
  const fs::path times = folder / "times.txt";
  const fs::path calibration = folder / "calib.txt";
  for (const auto& [left, right] : {std::pair('0', '1'), std::pair('2', '3')}) {
    const auto image = [&](const char* digits, char camera) {
      return folder / fmt::format("image_{}{}", digits, camera);
    };
    if (fs::is_directory(image("", left), error)) {
      return KittiFiles{image("", left), image("", right), times, calibration, left, right};
    }
    if (fs::is_directory(image("0", left) / "data", error)) {
      const fs::path raw = "calib_cam_to_cam.txt";
      const fs::path day = fs::weakly_canonical(folder, error).parent_path();
      return KittiFiles{image("0", left) / "data",
                        image("0", right) / "data",
                        FirstThere({times, image("0", left) / kRawTimes}),
                        FirstThere({calibration, folder / raw, day / raw}),
                        left,
                        right};
    }
  }
  return std::nullopt;
}

KittiFiles FindKittiFiles(const fs::path& folder) {
  if (auto files = FindIn(folder)) {
    return *std::move(files);
  }
  throw InputError(
      folder.string() +
      ": has no folder image_0 or image_2, expected a sequence of KITTI's odometry "
      "benchmark, or of its raw data, rectified, with image_00/data or image_02/data" +
      SuggestFolder(folder, [](const fs::path& other) { return FindIn(other).has_value(); }));
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

// What a name shares with its partner's name: the whole name, or only its last number where the
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

// The folders of the left and of the right images; empty if there are neither.
std::pair<fs::path, fs::path> FindSides(const fs::path& path) {
  std::error_code error;
  const auto find = [&](std::initializer_list<const char*> names) {
    const auto* const found = std::ranges::find_if(
        names, [&](const char* name) { return fs::is_directory(path / name, error); });
    return found != names.end() ? path / *found : fs::path();
  };
  // make_synthetic writes the left images where its RGB-D sequences have them; TartanAir has other
  // names.
  fs::path left = find({"left", "image_left", "rgb"});
  fs::path right = find({"right", "image_right"});
  if (left.empty() != right.empty()) {
    throw InputError(
        fmt::format("{}: has a folder {} but none {}, expected both", path.string(),
                    left.empty() ? right.filename().string() : left.filename().string(),
                    left.empty() ? "left" : "right"));
  }
  return {std::move(left), std::move(right)};
}

}  // namespace

StereoSequence OpenKittiPairs(const fs::path& folder, const FrameSelection& selection,
                              const std::shared_ptr<const StereoRectifier>& rectifier) {
  const KittiFiles files = FindKittiFiles(folder);
  StereoSequence sequence;
  sequence.images.dataset = "kitti";
  if (rectifier == nullptr) {
    sequence.calibration.camera =
        CameraOfPair(files.calibration, files.left_camera, files.right_camera);
  }
  sequence.images.frames =
      ListKittiImages(files.times, files.left, files.right, sequence.images.warnings);
  FinishKitti(folder, selection, sequence.images, sequence.calibration);
  if (rectifier != nullptr) {
    sequence.calibration.camera = rectifier->camera();
  }
  LoadWithoutDepth(sequence.images);
  RectifyPairs(rectifier, sequence.images);
  return sequence;
}

LeftSequence OpenKittiImages(const fs::path& folder, const FrameSelection& selection) {
  const KittiFiles files = FindKittiFiles(folder);
  LeftSequence sequence;
  sequence.images.dataset = "kitti_left";
  sequence.calibration.camera = CameraOf(files.calibration, files.left_camera);
  sequence.images.frames = ListKittiImages(files.times, files.left, {}, sequence.images.warnings);
  FinishKitti(folder, selection, sequence.images, sequence.calibration);
  return sequence;
}

ImageSequence OpenStereoFolder(const fs::path& path, const StereoFolderOptions& options) {
  std::error_code error;
  const auto [left, right] = FindSides(path);
  if (left.empty()) {
    ImageSequence halves =
        OpenImageStream(path, {.frames_per_second = fs::is_directory(path, error)
                                                        ? std::optional(options.frames_per_second)
                                                        : std::nullopt,
                               .selection = options.selection})
            .images;
    SplitHalves(halves);
    RectifyPairs(options.rectifier, halves);
    halves.dataset = "stereo_folder";
    return halves;
  }
  ImageSequence sequence;
  sequence.dataset = "stereo_folder";
  PairFolders(left, right, options.frames_per_second, sequence);
  for (const char* const name : {"groundtruth.txt", "pose_left.txt"}) {  // the latter of TartanAir
    if (!sequence.groundtruth && fs::is_regular_file(path / name, error)) {
      sequence.groundtruth = path / name;
    }
  }
  SelectFrames(path, options.selection, sequence);
  LoadWithoutDepth(sequence);
  RectifyPairs(options.rectifier, sequence);
  return sequence;
}

}  // namespace hullslam

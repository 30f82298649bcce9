// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "datasets/row_tools.h"
#include "datasets/rows.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/sequences/stereo_sequence.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Rectifier = std::shared_ptr<const StereoRectifier>;

// ---- data sets whose files have the calibration of the pair

// Opens pairs with a rectifier of the user's settings, or with the calibration of the data set.
using OpenSequence = StereoSequence (*)(const fs::path&, const FrameSelection&, Rectifier);

StereoSequence OpenKitti(const fs::path& folder, const FrameSelection& selection,
                         Rectifier rectifier) {
  return OpenKittiPairs(folder, selection, rectifier);
}

// `source` names the files of the calibration.
OpenedDataset OpenCalibrated(const DatasetRequest& request, const char* source, OpenSequence open) {
  return OpenPairs(request, request.settings, true,
                   [&](const Rectifier& rectifier, OpenedDataset& opened) {
                     StereoSequence pairs = open(request.path, request.selection, rectifier);
                     opened.sequence = std::move(pairs.images);
                     if (request.settings.empty()) {
                       opened.notes = {DescribeSettings(source, "the cameras of the sequence")};
                     }
                     return pairs.calibration;
                   });
}

DatasetHelp HelpOfEurocStereo(SensorKind /*sensor*/) {
  return {.sequence = "folder with mav0, in the format ASL, with cam0 and cam1",
          .settings =
              "default: the cameras of the two sensor.yaml, or of a camchain of "
              "Kalibr, in SEQUENCE",
          .groundtruth =
              "of the left camera; default: state_groundtruth_estimate0, mocap0 "
              "or groundtruth.txt in SEQUENCE"};
}

bool IsEurocStereo(const fs::path& folder, SensorKind sensor) {
  return sensor == SensorKind::kStereo &&
         ((IsThere(folder / "mav0" / "cam0") && IsThere(folder / "mav0" / "cam1")) ||
          (IsThere(folder / "cam0" / "data.csv") && IsThere(folder / "cam1" / "data.csv")));
}

OpenedDataset OpenEurocStereo(const DatasetRequest& request) {
  return OpenCalibrated(request, "two sensor.yaml or a camchain", OpenEurocPairs);
}

ImageSequence OpenEurocStereoImages(const ImagesRequest& request) {
  return OpenEurocPairs(request.path, {}, RectifierOfRun(request, true)).images;
}

DatasetHelp HelpOfKitti(SensorKind /*sensor*/) {
  return {.sequence =
              "folder of KITTI's odometry benchmark: image_0 and image_1, or "
              "image_2 and image_3, calib.txt and times.txt; or a rectified drive of its "
              "raw data",
          .settings = "default: the cameras of calib.txt in SEQUENCE",
          .groundtruth =
              "default: groundtruth.txt or poses.txt in SEQUENCE, or "
              "poses/NAME.txt of the data set"};
}

bool IsKittiStereo(const fs::path& folder, SensorKind sensor) {
  const auto has = [&](const char* left, const char* right, const char* inside) {
    return IsFolderThere(folder / left / inside) && IsFolderThere(folder / right / inside);
  };
  return sensor == SensorKind::kStereo &&
         (has("image_0", "image_1", "") || has("image_2", "image_3", "") ||
          has("image_00", "image_01", "data") || has("image_02", "image_03", "data"));
}

OpenedDataset OpenKittiStereo(const DatasetRequest& request) {
  return OpenCalibrated(request, "the calibration of KITTI", OpenKitti);
}

ImageSequence OpenKittiStereoImages(const ImagesRequest& request) {
  return OpenKittiPairs(request.path, {}, RectifierOfRun(request, true)).images;
}

// ---- folders or videos of pairs, whose calibration is a settings file

constexpr std::array<DatasetOption, 1> kFolderOptions = {
    {{"side-by-side", "side_by_side", "",
      "each image shows both halves of a stereo pair, the left one first", "yes"}}};

DatasetHelp HelpOfStereoFolder(SensorKind /*sensor*/) {
  return {.sequence =
              "folder with left and right, or a video or folder of images that show both halves "
              "side by side",
          .settings =
              "default: camera.yaml in SEQUENCE; of rectified images with Camera.bf, or with "
              "both cameras as in files of ORB-SLAM2 (LEFT.K ...) and ORB-SLAM3 (Camera2.fx, "
              "Stereo.T_c1_c2), Kalibr or ROS (left.yaml beside right.yaml)",
          .groundtruth = "default: groundtruth.txt in SEQUENCE"};
}

bool IsTartanAir(const fs::path& folder) {
  return IsFolderThere(folder / "image_left") && IsFolderThere(folder / "image_right");
}

// Images side by side are not recognised: a program that may read others asks for --side-by-side.
bool IsStereoFolder(const fs::path& folder, SensorKind /*sensor*/) {
  return ((IsFolderThere(folder / "left") || IsFolderThere(folder / "rgb")) &&
          IsFolderThere(folder / "right")) ||
         IsTartanAir(folder);
}

fs::path FindFolderSettings(const DatasetRequest& request) {
  if (!request.settings.empty()) {
    return request.settings;
  }
  fs::path own = request.path / "camera.yaml";
  if (!IsThere(own) && IsTartanAir(request.path)) {
    return FindConfigFolder() / "TartanAir.yaml";  // all its sequences have the same camera
  }
  if (!IsThere(own)) {
    throw InputError(request.path.string() +
                     ": has no camera.yaml, expected --settings FILE with the calibration of "
                     "the stereo camera");
  }
  return own;
}

OpenedDataset OpenFolder(const DatasetRequest& request) {
  const fs::path file = FindFolderSettings(request);
  return OpenPairs(request, file, false, [&](const Rectifier& rectifier, OpenedDataset& opened) {
    const double rate = opened.settings.options.frames_per_second;
    opened.sequence = OpenStereoFolder(
        request.path,
        {.rectifier = rectifier, .frames_per_second = rate, .selection = request.selection});
    opened.sequence.choices["frames_per_second"] = fmt::format("{}", rate);
    if (request.settings.empty()) {
      opened.notes = {DescribeSettings(file, "of the sequence")};
    }
    return CameraCalibration();
  });
}

ImageSequence OpenFolderImages(const ImagesRequest& request) {
  StereoFolderOptions options;
  options.frames_per_second = NumberOf(request.choices, "frames_per_second", request.origin)
                                  .value_or(options.frames_per_second);
  options.rectifier = RectifierOfRun(request, false);
  return OpenStereoFolder(request.path, options);
}

}  // namespace

Dataset EurocStereoDataset() {
  return {.name = "euroc_stereo",
          .program = "euroc",
          .meaning = "a sequence of EuRoC with two cameras, in the format ASL",
          .sensors = {SensorKind::kStereo},
          .help = HelpOfEurocStereo,
          .options = {},
          .is_meant = IsEurocStereo,
          .open = OpenEurocStereo,
          .open_images = OpenEurocStereoImages};
}

Dataset KittiDataset() {
  return {.name = "kitti",
          .program = "kitti",
          .meaning = "a sequence of KITTI's odometry benchmark with two cameras",
          .sensors = {SensorKind::kStereo},
          .help = HelpOfKitti,
          .options = {},
          .is_meant = IsKittiStereo,
          .open = OpenKittiStereo,
          .open_images = OpenKittiStereoImages};
}

Dataset StereoFolderDataset() {
  return {.name = "stereo_folder",
          .program = "folder",
          .meaning = "folders or a video of stereo pairs",
          .sensors = {SensorKind::kStereo},
          .help = HelpOfStereoFolder,
          .options = kFolderOptions,
          .is_meant = IsStereoFolder,
          .open = OpenFolder,
          .open_images = OpenFolderImages};
}

}  // namespace hullslam

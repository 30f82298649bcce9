// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <utility>

#include "datasets/row_tools.h"
#include "datasets/rows.h"
#include "hullslam/sequences/bag_sequence.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr DatasetOption kRecordingTimes = {
    "recording-times", "times", "",
    "take the times at which the messages were recorded, not the stamps in them", "recording"};

constexpr std::array<DatasetOption, 5> kBagOptions = {
    {{"image-topic", "image_topic", "TOPIC",
      "topic of the images (default: found by type, encoding and name)"},
     {"depth-topic", "depth_topic", "TOPIC",
      "topic of the depth images (default: found likewise; not for monocular SLAM)"},
     {"info-topic", "info_topic", "TOPIC",
      "topic of the camera (default: camera_info beside the images)"},
     kRecordingTimes,
     {"float-units", "float_units", "N",
      "values of depth images of the encoding 32FC1 per metre (default: 1; 1000 if they are in "
      "millimetres)"}}};

constexpr std::array<DatasetOption, 5> kStereoBagOptions = {
    {{"image-topic", "image_topic", "TOPIC",
      "topic of the left images (default: of the topics whose names differ by left and right, "
      "infra1 and infra2, cam0 and cam1)"},
     {"right-topic", "right_topic", "TOPIC", "topic of the right images (default: likewise)"},
     {"info-topic", "info_topic", "TOPIC",
      "topic of the left camera (default: camera_info beside the images)"},
     {"right-info-topic", "right_info_topic", "TOPIC",
      "topic of the right camera (default: likewise)"},
     kRecordingTimes}};

DatasetHelp HelpOfBag(SensorKind sensor) {
  return {.sequence =
              "recording of ROS: an MCAP file, a .db3 file or a folder of rosbag2, or a "
              "bag of ROS 1",
          .settings = sensor == SensorKind::kRgbd
                          ? "default: the camera of the recording's CameraInfo, and depth images "
                            "of 16 bits in millimetres"
                          : "default: the camera of the recording's CameraInfo",
          .associations = "not for recordings, whose images are paired by their stamps",
          .groundtruth = "default: none"};
}

DatasetHelp HelpOfStereoBag(SensorKind /*sensor*/) {
  return {.sequence =
              "recording of ROS with two topics of images: an MCAP file, a .db3 file or a "
              "folder of rosbag2, or a bag of ROS 1",
          .settings = "default: the cameras of the two CameraInfo of the recording",
          .groundtruth = "default: none"};
}

bool IsBag(const fs::path& path) {
  if (IsFolderThere(path)) {
    return IsThere(path / "metadata.yaml");
  }
  constexpr std::array kEndings = {".bag", ".db3", ".mcap"};
  return std::ranges::find(kEndings, path.extension().string()) != kEndings.end();
}

bool HasSensor(const fs::path& path, SensorKind sensor) {
  if (!IsBag(path) || sensor == SensorKind::kMonocular) {
    return IsBag(path);
  }
  try {
    return std::ranges::count(FindBagSensors(path), sensor) > 0;
  } catch (const InputError&) {
    return false;  // whoever opens it says what is wrong
  }
}

BagSequenceOptions OptionsOf(const DatasetChoices& choices, const char* origin = "") {
  return {.image_topic = TextOf(choices, "image_topic"),
          .depth_topic = TextOf(choices, "depth_topic"),
          .info_topic = TextOf(choices, "info_topic"),
          .right_topic = TextOf(choices, "right_topic"),
          .right_info_topic = TextOf(choices, "right_info_topic"),
          .use_recording_times = TextOf(choices, "times") == "recording",
          .float_units = NumberOf(choices, "float_units", origin).value_or(1.0)};
}

void AddWarnings(std::vector<std::string> warnings, ImageSequence& sequence) {
  std::ranges::move(warnings, std::back_inserter(sequence.warnings));
}

LoadedSettings SettingsOfBag(const DatasetRequest& request, const BagSequence& bag) {
  if (!bag.camera) {
    return LoadSettings(request.settings, request.preset, request.overrides);
  }
  // Depth images of ROS are in millimetres (REP 118). What the user sets comes later and wins.
  std::vector<std::string> overrides = {"DepthMapFactor=1000"};
  overrides.insert(overrides.end(), request.overrides.begin(), request.overrides.end());
  return LoadSettings(*bag.camera, request.path.string(), request.preset, overrides);
}

OpenedDataset OpenBag(const DatasetRequest& request) {
  if (!request.associations.empty()) {
    throw InputError(
        "--associations is given, but the images of a recording are paired by their stamps");
  }
  BagSequenceOptions options = OptionsOf(request.choices);
  options.use_depth = request.sensor == SensorKind::kRgbd;
  options.need_camera = request.settings.empty();
  options.selection = request.selection;
  BagSequence bag = OpenBagSequence(request.path, options);
  AddWarnings(std::move(bag.warnings), bag.images);
  LoadedSettings settings = SettingsOfBag(request, bag);
  if (!options.need_camera) {
    bag.notes.push_back(DescribeGivenSettings(request.settings));
  }
  return {.settings = std::move(settings),
          .sequence = std::move(bag.images),
          .notes = std::move(bag.notes)};
}

ImageSequence OpenBagImages(const ImagesRequest& request) {
  BagSequenceOptions options = OptionsOf(request.choices, request.origin);
  options.use_depth = request.use_depth;
  options.need_camera = false;
  return OpenBagSequence(request.path, options).images;
}

OpenedDataset OpenStereoBag(const DatasetRequest& request) {
  BagSequenceOptions options = OptionsOf(request.choices);
  options.need_camera = request.settings.empty();
  options.selection = request.selection;
  return OpenPairs(request, request.settings, false,
                   [&](const auto& rectifier, OpenedDataset& opened) {
                     BagPairs bag = OpenBagPairs(request.path, options, rectifier);
                     AddWarnings(std::move(bag.warnings), bag.images);
                     opened.sequence = std::move(bag.images);
                     opened.notes = std::move(bag.notes);
                     return bag.calibration.value_or(CameraCalibration());
                   });
}

ImageSequence OpenStereoBagImages(const ImagesRequest& request) {
  BagSequenceOptions options = OptionsOf(request.choices, request.origin);
  options.need_camera = !options.info_topic.empty();
  return OpenBagPairs(request.path, options, RectifierOfRun(request, false)).images;
}

}  // namespace

Dataset BagDataset() {
  return {.name = "bag",
          .program = "bag",
          .meaning = "a recording of ROS",
          .sensors = {SensorKind::kRgbd, SensorKind::kMonocular},
          .help = HelpOfBag,
          .options = kBagOptions,
          .is_meant = HasSensor,
          .open = OpenBag,
          .open_images = OpenBagImages};
}

Dataset StereoBagDataset() {
  return {.name = "bag_stereo",
          .program = "bag",
          .meaning = "a recording of ROS with two topics of images",
          .sensors = {SensorKind::kStereo},
          .help = HelpOfStereoBag,
          .options = kStereoBagOptions,
          .is_meant = HasSensor,
          .open = OpenStereoBag,
          .open_images = OpenStereoBagImages};
}

}  // namespace hullslam

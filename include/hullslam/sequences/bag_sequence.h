// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/frame/stereo_rectifier.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/settings/settings.h"

namespace hullslam {

struct BagSequenceOptions {
  // Names of topics; empty: they are found by type, encoding and name (docs/datasets.md).
  std::string image_topic = {};
  std::string depth_topic = {};
  std::string info_topic = {};
  // Only for OpenBagPairs, whose left images come from `image_topic`.
  std::string right_topic = {};
  std::string right_info_topic = {};
  // False for monocular SLAM: all images are frames, and no frame has depth.
  bool use_depth = true;
  // False if the settings of the camera are known: then no CameraInfo is needed.
  bool need_camera = true;
  // The time stamps are those at which the messages were recorded, not those in the messages.
  bool use_recording_times = false;
  // Values of depth images of the encoding 32FC1 per metre; 1000 if they are in millimetres.
  double float_units = 1.0;
  FrameSelection selection = {};
};

struct BagSequence {
  // The names of the frames are their time stamps with six decimals, as in TUM's sequences.
  ImageSequence images;
  // From CameraInfo, which has no baseline: PinholeCamera::bf is the default. Absent without
  // `need_camera`.
  std::optional<CameraCalibration> camera;
  std::vector<std::string> notes;     // which topics are used
  std::vector<std::string> warnings;  // what is missing in the file, or odd about its stamps
};

// Opens a recording: a file in the format of MCAP (messages of ROS or Foxglove), of rosbag2
// (SQLite) or of ROS 1 (2.0), or a folder of rosbag2. The file is read once to find its images, of
// which only the positions are kept; they are decoded when they are loaded. Colour and depth images
// are paired by time: one to one, closest first, within 0.02 s.
//
// Throws InputError with the file and the position of what is broken; with a list of the topics if
// a topic is missing or if there is a choice; and with the topic and the two stamps if stamps go
// back by more than a second.
BagSequence OpenBagSequence(const std::filesystem::path& path,
                            const BagSequenceOptions& options = {});

// The sensors for which the recording has topics, found as the functions here find them. Reads the
// file once. Throws InputError as OpenBagSequence() does for a file that cannot be read.
std::vector<SensorKind> FindBagSensors(const std::filesystem::path& path);

struct BagPairs {
  ImageSequence images;
  // Of the rectified images, with the baseline. Absent without `need_camera`.
  std::optional<CameraCalibration> calibration;
  std::vector<std::string> notes;  // as in BagSequence
  std::vector<std::string> warnings;
};

// Opens a recording with two topics of images of a stereo camera as OpenBagSequence does. Pairs are
// one to one, within a twentieth of the time between two images; images without a partner are
// counted in a warning. With `need_camera`, the images are rectified by the two CameraInfo, unless
// the name of their topic says that they are rectified already; else by `rectifier`, which is null
// for rectified images.
BagPairs OpenBagPairs(const std::filesystem::path& path, const BagSequenceOptions& options = {},
                      std::shared_ptr<const StereoRectifier> rectifier = nullptr);

}  // namespace hullslam

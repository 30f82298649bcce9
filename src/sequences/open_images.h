// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

struct OpenImagesOptions {
  bool has_two_halves = false;   // each image shows a stereo pair side by side
  std::string image_topic = {};  // of a recording of ROS; empty: found by type and name
};

// Opens the images that a SLAM program would track, of whatever kind the file or folder is; of a
// stereo camera those on the left. No calibration is needed. Files of recordings are known by their
// endings, other files are videos; folders are known by the files in them. Throws InputError as the
// function does that opens this kind.
ImageSequence OpenImages(const std::filesystem::path& path, const OpenImagesOptions& options = {});

// The image of a frame in colour, CV_8UC3 with blue first, as it is stored: masks are of these
// pixels. To be called like ImageSequence::load.
cv::Mat ReadFrameColour(const ImageSequence& sequence, const FramePaths& frame);

}  // namespace hullslam

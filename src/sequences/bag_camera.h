// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/stereo_rectifier.h"
#include "sequences/bag_topics.h"

namespace hullslam {

// The camera of a CameraInfo, and how it was read.
struct InfoCamera {
  PinholeCamera camera;
  std::string note;
};

// The camera of the images of a topic with this CameraInfo: K and the distortion, or P if the
// images are rectified by the name of their topic (IsRectifiedTopic). Throws InputError with
// recording and topic if the CameraInfo does not tell it.
InfoCamera CameraOfInfo(const std::filesystem::path& path, const IndexedTopic& info,
                        const IndexedTopic& images);

// The pair of two CameraInfo. The projections are for rectified images; the fourth column of
// the right one is minus the baseline times the focal length. Adds how they were read to `notes`.
// Throws likewise.
StereoCalibration PairOfInfos(const std::filesystem::path& path,
                              const std::array<const IndexedTopic*, 2>& infos,
                              const std::array<const IndexedTopic*, 2>& images,
                              std::vector<std::string>& notes);

}  // namespace hullslam

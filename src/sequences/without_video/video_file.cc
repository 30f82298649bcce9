// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/video_file.h"

#include <utility>

#include "util/components.h"

namespace hullslam {

class VideoFile::Decoder {};

VideoFile::VideoFile(std::filesystem::path path) : path_(std::move(path)) {
  RequireComponent("VIDEO", path_.string() + " is a video");
}

VideoFile::~VideoFile() = default;

// No object of this class exists.
std::vector<double> VideoFile::ReadStamps() { return {}; }
cv::Mat VideoFile::ReadGrey(size_t) { return {}; }
cv::Mat VideoFile::ReadColour(size_t) { return {}; }
std::string VideoFile::DescribeTurn() const { return {}; }

}  // namespace hullslam

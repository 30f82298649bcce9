// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace hullslam {

// All throw InputError, with the file and the reason, where it is missing, empty, cut off, neither
// PNG nor JPEG, beyond 64 million pixels, or does not decode. (Bits that flipped inside a JPEG
// cannot be told from a picture.)

// The luma of a PNG or JPEG image, CV_8UC1. An orientation in EXIF data is not applied: pixels stay
// where the camera's calibration has them.
cv::Mat ReadGreyImage(const std::filesystem::path& path);

// A depth image as it is, CV_16UC1. Other depths than 16 bits or more channels are errors too.
cv::Mat ReadDepthImage(const std::filesystem::path& path);

// The same of an image with the number of an instance in each pixel.
cv::Mat ReadLabelImage(const std::filesystem::path& path);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

#include "hullslam/camera/pinhole.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// Reads one mask for all images (Sensor::mask_all): a PNG with up to 8 bits per channel. Pixels
// that are black, 0 in all channels, are ignored; all others are used. The result is 0 or 255.
// Throws InputError with the file and the reason, also for a JPEG, whose black pixels may have
// become dark ones, and for a mask that is black everywhere.
cv::Mat ReadMaskAll(const std::filesystem::path& path);

// The mask of the images that the sequence gives, which have the size of the camera: rectified or
// resized as they are. Throws InputError unless the mask has the size of the images as read.
cv::Mat ReadMaskAll(const std::filesystem::path& path, const ImageSequence& sequence,
                    const PinholeCamera& camera, ImageSide side = ImageSide::kLeft);

// The share of the pixels that a mask ignores.
double IgnoredShare(const cv::Mat& mask_all);

}  // namespace hullslam

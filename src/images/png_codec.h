// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "images/image_header.h"

namespace hullslam {

// The reason why the bytes of a PNG or JPEG cannot be decoded, as the end of "FILE ...".
class DecodeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Decodes a PNG by libpng. All pixels must be there and all checksums must be right. Grey and
// colour values are as from cv::imdecode. Throws DecodeError.
cv::Mat DecodePng(std::string_view bytes, PixelForm form, const HeaderCheck& check);

// The bytes of a PNG with an image of 8 or 16 bits and 1 or 3 channels, blue first. They are those
// of cv::imencode, whose settings are fast: the filter of the left neighbour and runs of equal
// bytes.
std::string EncodePng(const cv::Mat& image);

}  // namespace hullslam

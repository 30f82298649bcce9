// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

#include "images/image_header.h"

namespace hullslam {

// Decodes a JPEG by libjpeg-turbo. Its end must be there; anything may follow it. Grey values are
// the luma as stored, and all values are as from cv::imdecode. Throws DecodeError.
cv::Mat DecodeJpeg(std::string_view bytes, PixelForm form, const HeaderCheck& check);

// The bytes of a JPEG with an image of 8 bits and 1 or 3 channels, blue first, as from
// cv::imencode. `quality` is from 0 to 100.
std::string EncodeJpeg(const cv::Mat& image, int quality);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

namespace hullslam {

// A depth image, CV_16UC1, that compressed_depth_image_transport compressed with RVL (Wilson, "Fast
// lossless depth image compression", ISS 2017): width and height with four bytes each, then the
// stream. Throws InputError that begins with `name` if the bytes are cut off or broken.
cv::Mat DecodeRvl(std::string_view bytes, const std::string& name);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

#include "bags/image_messages.h"

namespace hullslam {

// The images in messages of ROS. A raw image is a sensor_msgs/Image with the encoding mono8, 8UC1,
// bgr8, 8UC3, rgb8, bgra8, 8UC4 or rgba8 (colour), or 16UC1, mono16 or 32FC1 (depth). A compressed
// one is a PNG or JPEG, or a depth image of compressed_depth_image_transport: twelve bytes, then a
// PNG.

enum class BagImageKind { kColour, kDepth, kUnknown };

// What an image shows, by the encoding of a raw image or the format of a compressed one.
BagImageKind KindOfEncoding(std::string_view encoding);
BagImageKind KindOfFormat(std::string_view format);

// The luma, CV_8UC1. For the same pixels it has the same values as that of a PNG. All functions
// throw InputError that begins with `name` for an image of another kind, of a size that does not
// fit its bytes or is too large, or that cannot be decoded.
cv::Mat GreyOf(const RawImageMessage& message, const std::string& name);
cv::Mat GreyOf(const CompressedImageMessage& message, const std::string& name);

// The image in colour, CV_8UC3 with blue first.
cv::Mat ColourOf(const RawImageMessage& message, const std::string& name);
cv::Mat ColourOf(const CompressedImageMessage& message, const std::string& name);

// The depth, CV_16UC1 in the units of the message or CV_32FC1 in metres.
cv::Mat DepthOf(const RawImageMessage& message, const std::string& name);
cv::Mat DepthOf(const CompressedImageMessage& message, const std::string& name);

}  // namespace hullslam

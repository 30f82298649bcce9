// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

#include "bags/image_messages.h"

namespace hullslam {

// The images in messages. The encodings of raw images are in a table in bag_image.cc. A compressed
// image is a PNG or JPEG, or a depth image of compressed_depth_image_transport: twelve bytes, then
// a PNG or a stream of RVL.

// kEither is grey with 16 bits (mono16): cameras of 10 to 16 bits have it, and some depth cameras.
enum class BagImageKind { kColour, kDepth, kEither, kUnknown };

// The kind of an image, by the encoding of a raw image or the format of a compressed one.
BagImageKind KindOfEncoding(std::string_view encoding);
BagImageKind KindOfFormat(std::string_view format);
// The names of the encodings of raw images that are read.
std::string ReadEncodings(BagImageKind kind);

// The largest value of an image with 16 bits; 0 for other images, and for images that cannot be
// read.
uint16_t BrightestOf(const RawImageMessage& message);

// The luma, CV_8UC1. For the same pixels it has the same values as from a PNG. All functions
// throw InputError that begins with `name` for an image of another kind, of a size that does not
// fit its bytes or is too large, or that cannot be decoded. `brightest` is the largest value of all
// images of the topic, if they have 16 bits: it tells how many of the bits the camera uses.
cv::Mat GreyOf(const RawImageMessage& message, const std::string& name,
               uint16_t brightest = 0xffff);
cv::Mat GreyOf(const CompressedImageMessage& message, const std::string& name);

// The image in colour, CV_8UC3 with blue first.
cv::Mat ColourOf(const RawImageMessage& message, const std::string& name,
                 uint16_t brightest = 0xffff);
cv::Mat ColourOf(const CompressedImageMessage& message, const std::string& name);

// The depth, CV_16UC1 in the units of the message or CV_32FC1 in metres.
cv::Mat DepthOf(const RawImageMessage& message, const std::string& name);
cv::Mat DepthOf(const CompressedImageMessage& message, const std::string& name);

}  // namespace hullslam

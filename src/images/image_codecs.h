// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

namespace hullslam {

// The header of an encoded image, as it is stored.
struct ImageHeader {
  uint64_t width = 0;   // px
  uint64_t height = 0;  // px
  int channels = 0;
  int bits = 0;  // per channel
  bool has_palette = false;
};

// Is called when a header was read, before memory for the pixels is allocated. Throws if the image
// is not accepted.
using HeaderCheck = std::function<void(const ImageHeader&)>;

// The pixels that a decoder returns: CV_8UC1, CV_8UC3 with blue first, or CV_16UC1 and CV_16UC3 as
// the image has them. Only images of 16 bits can be decoded to the last ones.
enum class PixelForm { kGrey, kColour, kSixteenBit };

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

// Decodes a JPEG by libjpeg-turbo. Its end must be there; anything may follow it. Grey values are
// the luma as stored, and all values are as from cv::imdecode. Throws DecodeError.
cv::Mat DecodeJpeg(std::string_view bytes, PixelForm form, const HeaderCheck& check);

// The bytes of a JPEG with an image of 8 bits and 1 or 3 channels, blue first, as from
// cv::imencode. `quality` is from 0 to 100.
std::string EncodeJpeg(const cv::Mat& image, int quality);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>

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

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "images/rvl_depth.h"

#include <fmt/format.h>

#include <cstdint>
#include <utility>

#include "files/bytes.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"

namespace hullslam {
namespace {

// The numbers of a stream: words of 32 bits hold eight groups of four bits, the highest first. The
// lower three bits of a group are a part of the number, the lowest part first; the fourth bit says
// that another group follows.
class RvlNumbers {
 public:
  RvlNumbers(std::string_view bytes, std::string name) : reader_(bytes, std::move(name)) {}

  uint32_t Next() {
    uint32_t number = 0;
    for (unsigned shift = 0; shift < 32; shift += 3) {
      const uint32_t group = NextGroup();
      number |= (group & 7U) << shift;
      if (group < 8) {
        return number;
      }
    }
    reader_.Require(false, "has a number of more than 32 bits");
    return 0;
  }

 private:
  uint32_t NextGroup() {
    if (groups_left_ == 0) {
      word_ = reader_.Get<uint32_t>();
      groups_left_ = 8;
    }
    --groups_left_;
    const uint32_t group = word_ >> 28U;
    word_ <<= 4U;
    return group;
  }

  ByteReader reader_;
  uint32_t word_ = 0;
  int groups_left_ = 0;
};

}  // namespace

// Runs of zeros and runs of known depths alternate. Of a known depth, the difference from the
// previous known one is stored, with its sign in the lowest bit.
cv::Mat DecodeRvl(std::string_view bytes, const std::string& name) {
  const std::string place = name + ": the depth image";
  ByteReader head(bytes, place);
  const uint64_t width = head.Get<uint32_t>();
  const uint64_t height = head.Get<uint32_t>();
  if (width == 0 || height == 0 || width > kMostImagePixels || height > kMostImagePixels ||
      width * height > kMostImagePixels) {
    throw InputError(fmt::format("{} has {}x{} px, expected up to {} million px", place, width,
                                 height, kMostImagePixels / 1'000'000));
  }
  cv::Mat depth = cv::Mat::zeros(static_cast<int>(height), static_cast<int>(width), CV_16UC1);
  auto* const values = depth.ptr<uint16_t>();
  const uint64_t count = width * height;
  RvlNumbers numbers(head.GetRaw(head.left()), place);
  uint32_t value = 0;
  for (uint64_t at = 0; at < count;) {
    const uint64_t zeros = numbers.Next();
    const uint64_t known = numbers.Next();
    if (zeros + known > count - at || zeros + known == 0) {
      throw InputError(place + " is broken: its runs do not fill the image");
    }
    at += zeros;
    for (const uint64_t end = at + known; at < end; ++at) {
      const uint32_t difference = numbers.Next();
      value += (difference >> 1U) ^ (0U - (difference & 1U));
      values[at] = static_cast<uint16_t>(value);
    }
  }
  return depth;
}

}  // namespace hullslam

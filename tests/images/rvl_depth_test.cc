// SPDX-License-Identifier: GPL-3.0-or-later
#include "images/rvl_depth.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "files/bytes.h"
#include "support/expect_error.h"

namespace hullslam {
namespace {

// Compresses a depth image as Wilson 2017 describes it.
class RvlWriter {
 public:
  std::string Compress(const cv::Mat& depth) {
    bytes_.Put(static_cast<uint32_t>(depth.cols));
    bytes_.Put(static_cast<uint32_t>(depth.rows));
    const auto* const values = depth.ptr<uint16_t>();
    const size_t count = depth.total();
    int former = 0;
    for (size_t at = 0; at < count;) {
      const size_t zeros = at;
      for (; at < count && values[at] == 0; ++at) {
      }
      const size_t known = at;
      for (; at < count && values[at] != 0; ++at) {
      }
      PutNumber(static_cast<uint32_t>(known - zeros));
      PutNumber(static_cast<uint32_t>(at - known));
      for (size_t i = known; i < at; ++i) {
        const int difference = values[i] - former;
        PutNumber(static_cast<uint32_t>(difference < 0 ? -2 * difference - 1 : 2 * difference));
        former = values[i];
      }
    }
    while (groups_ > 0) {
      PutGroup(0);
    }
    return bytes_.bytes();
  }

 private:
  void PutNumber(uint32_t number) {
    for (; number > 7; number >>= 3U) {
      PutGroup((number & 7U) | 8U);
    }
    PutGroup(number);
  }
  void PutGroup(uint32_t group) {
    word_ = word_ << 4U | group;
    groups_ = (groups_ + 1) % 8;
    if (groups_ == 0) {
      bytes_.Put(word_);
    }
  }

  ByteWriter bytes_;
  uint32_t word_ = 0;
  int groups_ = 0;
};

cv::Mat MadeDepth() {
  cv::Mat depth(7, 9, CV_16UC1);
  cv::theRNG().state = 3;
  cv::randu(depth, 0, 65536);
  depth(cv::Rect(2, 1, 4, 3)).setTo(0);
  depth.row(6).setTo(0);
  return depth;
}

TEST(RvlDepthTest, GivesBackTheImage) {
  const cv::Mat depth = MadeDepth();
  EXPECT_EQ(cv::norm(DecodeRvl(RvlWriter().Compress(depth), "m"), depth, cv::NORM_INF), 0.0);
  const cv::Mat none = cv::Mat::zeros(3, 5, CV_16UC1);
  EXPECT_EQ(cv::countNonZero(DecodeRvl(RvlWriter().Compress(none), "m")), 0);
}

TEST(RvlDepthTest, CutAndBrokenImagesAreRefused) {
  const std::string whole = RvlWriter().Compress(MadeDepth());
  for (size_t kept = 0; kept + 4 <= whole.size(); kept += 5) {
    ExpectInputError([&] { DecodeRvl(whole.substr(0, kept), "m"); },
                     {"m: the depth image is cut off"});
  }
  std::string huge = whole;
  huge[3] = '\x7f';  // the width
  ExpectInputError([&] { DecodeRvl(huge, "m"); }, {"m: the depth image has 2130706441x7 px"});
  std::string small = whole;
  small[4] = '\x01';  // the height
  ExpectInputError([&] { DecodeRvl(small, "m"); }, {"its runs do not fill the image"});
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "images/eight_bits.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace hullslam {
namespace {

cv::Mat Values(const std::vector<uint16_t>& values) { return cv::Mat(values, true).reshape(1, 1); }

TEST(EightBits, TheHighestBitsOfTheCameraAreTaken) {
  struct Case {
    uint16_t brightest;
    int shift;
  };
  for (const Case& one : {Case{255, 0}, Case{900, 2}, Case{1023, 2}, Case{1024, 4}, Case{4095, 4},
                          Case{16383, 6}, Case{16384, 8}, Case{65535, 8}}) {
    const cv::Mat image = Values({0, one.brightest, static_cast<uint16_t>(7 << one.shift)});
    const cv::Mat scaled = To8Bits(image, one.brightest);
    ASSERT_EQ(scaled.type(), CV_8UC1);
    EXPECT_EQ(scaled.at<uint8_t>(0), 0);
    EXPECT_NEAR(scaled.at<uint8_t>(1), one.brightest >> one.shift, 1) << one.brightest;
    EXPECT_EQ(scaled.at<uint8_t>(2), 7) << one.brightest;
  }
}

TEST(EightBits, BrighterPixelsAreWhiteAndEightBitsStay) {
  EXPECT_EQ(To8Bits(Values({5000}), 1023).at<uint8_t>(0), 255);
  const cv::Mat image(3, 4, CV_8UC3, cv::Scalar(1, 2, 3));
  EXPECT_EQ(cv::norm(To8Bits(image, 1023), image, cv::NORM_INF), 0.0);
}

TEST(EightBits, GreyIsThatOfAPngInColour) {
  cv::Mat image(31, 47, CV_8UC3);
  cv::RNG(7).fill(image, cv::RNG::UNIFORM, 0, 256);
  std::vector<uint8_t> png;
  cv::imencode(".png", image, png);
  EXPECT_EQ(cv::norm(GreyLikePng(image, 2), cv::imdecode(png, cv::IMREAD_GRAYSCALE), cv::NORM_INF),
            0.0);
}

}  // namespace
}  // namespace hullslam

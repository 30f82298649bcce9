// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/bag_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "support/expect_error.h"

namespace hullslam {
namespace {

cv::Mat RandomImage(int type) {
  cv::Mat image(40, 50, type);
  cv::theRNG().state = 7;
  cv::randu(image, 0, 256);
  return image;
}

std::string EncodePng(const cv::Mat& image) {
  std::vector<uchar> bytes;
  cv::imencode(".png", image, bytes);
  return {bytes.begin(), bytes.end()};
}

// The message of an image. Each row has `gap` more bytes. Views refer to `bytes`.
RawImageMessage MessageOf(const cv::Mat& image, const char* encoding, std::string& bytes,
                          size_t gap = 0) {
  const size_t row = static_cast<size_t>(image.cols) * image.elemSize();
  bytes.clear();
  for (int y = 0; y < image.rows; ++y) {
    bytes.append(image.ptr<char>(y), row).append(gap, 'x');
  }
  return {.stamp = {},
          .height = static_cast<uint32_t>(image.rows),
          .width = static_cast<uint32_t>(image.cols),
          .encoding = encoding,
          .is_big_endian = false,
          .step = static_cast<uint32_t>(row + gap),
          .data = bytes};
}

bool AreEqual(const cv::Mat& a, const cv::Mat& b) {
  return a.type() == b.type() && a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

TEST(BagImageTest, RawColourHasTheGreyValuesOfItsPng) {
  const cv::Mat bgr = RandomImage(CV_8UC3);
  const std::string png = EncodePng(bgr);
  const CompressedImageMessage compressed{.stamp = {}, .format = "png", .data = png};
  const cv::Mat grey = GreyOf(compressed, "png");
  std::string bytes;
  EXPECT_TRUE(AreEqual(GreyOf(MessageOf(bgr, "bgr8", bytes), "raw"), grey));
  EXPECT_TRUE(AreEqual(ColourOf(MessageOf(bgr, "bgr8", bytes, 5), "raw"), bgr));
  EXPECT_TRUE(AreEqual(ColourOf(compressed, "png"), bgr));
  struct Other {
    const char* encoding;
    int conversion;
  };
  for (const Other& other : {Other{"rgb8", cv::COLOR_BGR2RGB}, Other{"bgra8", cv::COLOR_BGR2BGRA},
                             Other{"rgba8", cv::COLOR_BGR2RGBA}}) {
    cv::Mat converted;
    cv::cvtColor(bgr, converted, other.conversion);
    const RawImageMessage message = MessageOf(converted, other.encoding, bytes, 3);
    EXPECT_TRUE(AreEqual(GreyOf(message, "raw"), grey)) << other.encoding;
    EXPECT_TRUE(AreEqual(ColourOf(message, "raw"), bgr)) << other.encoding;
  }
  EXPECT_TRUE(AreEqual(GreyOf(MessageOf(grey, "mono8", bytes), "raw"), grey));
  EXPECT_EQ(ColourOf(MessageOf(grey, "mono8", bytes), "raw").type(), CV_8UC3);
}

TEST(BagImageTest, DepthIsReadInBothOrdersOfBytes) {
  cv::Mat depth(40, 50, CV_16UC1);
  cv::randu(depth, 0, 60000);
  cv::Mat metres;
  depth.convertTo(metres, CV_32FC1, 1e-4);
  std::string bytes;
  EXPECT_TRUE(AreEqual(DepthOf(MessageOf(depth, "16UC1", bytes), "raw"), depth));
  EXPECT_TRUE(AreEqual(DepthOf(MessageOf(depth, "mono16", bytes, 2), "raw"), depth));
  EXPECT_TRUE(AreEqual(DepthOf(MessageOf(metres, "32FC1", bytes), "raw"), metres));
  for (const cv::Mat& image : {depth, metres}) {
    const char* const encoding = image.depth() == CV_16U ? "16UC1" : "32FC1";
    std::string swapped;
    RawImageMessage message = MessageOf(image, encoding, swapped);
    for (auto at = swapped.begin(); at != swapped.end(); at += image.elemSize()) {
      std::reverse(at, at + static_cast<ptrdiff_t>(image.elemSize()));
    }
    message.is_big_endian = true;
    EXPECT_TRUE(AreEqual(DepthOf(message, "raw"), image)) << encoding;
  }
}

TEST(BagImageTest, CompressedDepthIsReadBehindItsTwelveBytes) {
  cv::Mat values(2, 3, CV_16UC1, cv::Scalar(100));
  values.at<uint16_t>(0, 0) = 0;
  const float parameters[2] = {250.0f, 50.0f};  // z = 250 / (value - 50)
  std::string head(12, '\0');
  std::memcpy(head.data() + 4, parameters, 8);
  const std::string data = head + EncodePng(values);
  const std::string png = EncodePng(values);
  EXPECT_TRUE(AreEqual(DepthOf(CompressedImageMessage{{}, "16UC1; compressedDepth png", data}, "m"),
                       values));
  EXPECT_TRUE(
      AreEqual(DepthOf(CompressedImageMessage{{}, "16UC1; png compressed ", png}, "m"), values));
  const cv::Mat metres = DepthOf(CompressedImageMessage{{}, "32FC1; compressedDepth", data}, "m");
  EXPECT_TRUE(std::isnan(metres.at<float>(0, 0)));
  EXPECT_FLOAT_EQ(metres.at<float>(1, 2), 5.0f);
  // A stream of RVL: two pixels of the depth 0, in one word.
  const std::string rvl = head + std::string("\x02\0\0\0\x01\0\0\0\0\0\0\x20", 12);
  const cv::Mat none = DepthOf(CompressedImageMessage{{}, "16UC1; compressedDepth rvl", rvl}, "m");
  EXPECT_EQ(none.size(), cv::Size(2, 1));
  EXPECT_EQ(cv::countNonZero(none), 0);
  ExpectInputError(
      [&] {
        DepthOf(CompressedImageMessage{{}, "16UC1; compressedDepth", "short"}, "m");
      },
      {"m: the depth image is cut off"});
}

// Each pixel of a Bayer pattern has one colour. In an image of one colour, each half of the pattern
// gives it back.
TEST(BagImageTest, BayerPatternsAreRead) {
  struct Pattern {
    const char* name;
    int red_x, red_y;
  };
  const cv::Vec3b bgr(40, 90, 200);
  for (const Pattern& pattern : {Pattern{"bayer_rggb8", 0, 0}, Pattern{"bayer_grbg8", 1, 0},
                                 Pattern{"bayer_gbrg8", 0, 1}, Pattern{"bayer_bggr8", 1, 1}}) {
    cv::Mat image(20, 30, CV_8UC1);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        const int reds = (x % 2 == pattern.red_x ? 1 : 0) + (y % 2 == pattern.red_y ? 1 : 0);
        image.at<uint8_t>(y, x) = bgr[reds];
      }
    }
    std::string bytes;
    EXPECT_EQ(ColourOf(MessageOf(image, pattern.name, bytes), "m").at<cv::Vec3b>(9, 9), bgr)
        << pattern.name;
    cv::Mat wide;
    image.convertTo(wide, CV_16UC1, 16.0);  // a camera of 12 bits
    const std::string name = std::string(pattern.name, std::strlen(pattern.name) - 1) + "16";
    const RawImageMessage message = MessageOf(wide, name.c_str(), bytes);
    EXPECT_EQ(ColourOf(message, "m", BrightestOf(message)).at<cv::Vec3b>(9, 9), bgr) << name;
    EXPECT_NEAR(GreyOf(message, "m", BrightestOf(message)).at<uint8_t>(9, 9), 117, 1) << name;
  }
}

TEST(BagImageTest, PixelsThatShareTheirColourAreRead) {
  cv::Mat image(2, 4, CV_8UC2);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) {
      image.at<cv::Vec2b>(y, x) = {static_cast<uint8_t>(126), static_cast<uint8_t>(128)};
    }
  }
  std::string bytes;
  for (const char* const name : {"yuv422_yuy2", "yuyv"}) {  // brightness, then colour
    EXPECT_NEAR(GreyOf(MessageOf(image, name, bytes), "m").at<uint8_t>(1, 2), 128, 1) << name;
  }
  for (const char* const name : {"yuv422", "uyvy"}) {  // colour, then brightness
    const cv::Vec3b bgr = ColourOf(MessageOf(image, name, bytes), "m").at<cv::Vec3b>(1, 2);
    EXPECT_NEAR(bgr[1], 132, 2) << name;
  }
}

// Cameras of 10 or 12 bits leave the highest bits empty.
TEST(BagImageTest, GreyOf16BitsUsesTheBitsOfItsTopic) {
  cv::Mat image(4, 4, CV_16UC1, cv::Scalar(1600));
  std::string bytes;
  const RawImageMessage message = MessageOf(image, "mono16", bytes);
  EXPECT_EQ(BrightestOf(message), 1600);
  EXPECT_EQ(GreyOf(message, "m", 4000).at<uint8_t>(1, 1), 100);
  EXPECT_EQ(GreyOf(message, "m", 60000).at<uint8_t>(1, 1), 6);
  EXPECT_EQ(ColourOf(message, "m", 4000).type(), CV_8UC3);
  EXPECT_EQ(DepthOf(message, "m").at<uint16_t>(1, 1), 1600);
  EXPECT_EQ(BrightestOf(MessageOf(image, "16UC1", bytes)), 0);
}

TEST(BagImageTest, KindsFollowTheEncoding) {
  EXPECT_EQ(KindOfEncoding("bgr8"), BagImageKind::kColour);
  EXPECT_EQ(KindOfEncoding("32FC1"), BagImageKind::kDepth);
  EXPECT_EQ(KindOfEncoding("bayer_rggb8"), BagImageKind::kColour);
  EXPECT_EQ(KindOfEncoding("mono16"), BagImageKind::kEither);
  EXPECT_EQ(KindOfEncoding("nv21"), BagImageKind::kUnknown);
  EXPECT_EQ(KindOfFormat("jpeg"), BagImageKind::kColour);
  EXPECT_EQ(KindOfFormat("bgr8; jpeg compressed bgr8"), BagImageKind::kColour);
  EXPECT_EQ(KindOfFormat("16UC1; compressedDepth png"), BagImageKind::kDepth);
  EXPECT_EQ(KindOfFormat("16UC1; png compressed "), BagImageKind::kDepth);
  EXPECT_EQ(KindOfFormat("h264"), BagImageKind::kUnknown);
}

TEST(BagImageTest, WrongKindsAndSizesAreRefused) {
  std::string bytes;
  RawImageMessage message = MessageOf(RandomImage(CV_8UC3), "nv21", bytes);
  ExpectInputError([&] { GreyOf(message, "a.bag/1.5"); },
                   {"a.bag/1.5: the image is 'nv21'", "rgb8", "bayer_rggb8"});
  message.encoding = "bgr8";
  ExpectInputError([&] { DepthOf(message, "m"); }, {"'bgr8'", "16UC1"});
  message.step = 149;
  ExpectInputError([&] { GreyOf(message, "m"); }, {"50x40 px", "149 bytes", "at least 150 bytes"});
  message.step = 0;
  message.width = 0;
  ExpectInputError([&] { GreyOf(message, "m"); }, {"0x40 px"});
  message.width = 0xffffffff;
  message.height = 0xffffffff;
  message.step = 0;
  ExpectInputError([&] { GreyOf(message, "m"); }, {"64 million"});
  ExpectInputError(
      [] {
        GreyOf(CompressedImageMessage{{}, "png", "no png"}, "m");
      },
      {"m: is neither a PNG nor a JPEG"});
}

}  // namespace
}  // namespace hullslam

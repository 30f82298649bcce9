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
  ExpectInputError(
      [&] {
        DepthOf(CompressedImageMessage{{}, "16UC1; compressedDepth rvl", data}, "m");
      },
      {"m: the image is '16UC1; compressedDepth rvl'", "PNG"});
  ExpectInputError(
      [&] {
        DepthOf(CompressedImageMessage{{}, "16UC1; compressedDepth", "short"}, "m");
      },
      {"m: the depth image is cut off"});
}

TEST(BagImageTest, KindsFollowTheEncoding) {
  EXPECT_EQ(KindOfEncoding("bgr8"), BagImageKind::kColour);
  EXPECT_EQ(KindOfEncoding("32FC1"), BagImageKind::kDepth);
  EXPECT_EQ(KindOfEncoding("bayer_rggb8"), BagImageKind::kUnknown);
  EXPECT_EQ(KindOfFormat("jpeg"), BagImageKind::kColour);
  EXPECT_EQ(KindOfFormat("bgr8; jpeg compressed bgr8"), BagImageKind::kColour);
  EXPECT_EQ(KindOfFormat("16UC1; compressedDepth png"), BagImageKind::kDepth);
  EXPECT_EQ(KindOfFormat("16UC1; png compressed "), BagImageKind::kDepth);
  EXPECT_EQ(KindOfFormat("h264"), BagImageKind::kUnknown);
}

TEST(BagImageTest, WrongKindsAndSizesAreRefused) {
  std::string bytes;
  RawImageMessage message = MessageOf(RandomImage(CV_8UC3), "yuv422", bytes);
  ExpectInputError([&] { GreyOf(message, "a.bag/1.5"); },
                   {"a.bag/1.5: the image is 'yuv422'", "rgb8"});
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

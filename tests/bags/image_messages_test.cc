// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/image_messages.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"
#include "support/made_bags.h"

namespace hullslam {
namespace {

constexpr uint64_t kTime = 1'305'031'102'175'304'000;  // ns

class ImageMessages : public ::testing::TestWithParam<MessageCoding> {};

TEST_P(ImageMessages, ARawImageIsRead) {
  const std::string bytes = MadeImage(GetParam(), kTime, "bgr8", 2, 3, "123456abcdefABCDEF");
  const RawImageMessage image = ReadRawImage(GetParam(), bytes, "m");
  EXPECT_EQ(image.stamp, (BagTime{1305031102, 175304000}));
  EXPECT_EQ(image.stamp.Seconds(), 1305031102.175304);
  EXPECT_EQ(image.width, 2u);
  EXPECT_EQ(image.height, 3u);
  EXPECT_EQ(image.encoding, "bgr8");
  EXPECT_EQ(image.step, 6u);
  EXPECT_EQ(image.data, "123456abcdefABCDEF");
  EXPECT_FALSE(image.is_big_endian);
}

TEST_P(ImageMessages, ACompressedImageIsRead) {
  const std::string bytes = MadeCompressed(GetParam(), kTime, "png", "bytes");
  const CompressedImageMessage image = ReadCompressedImage(GetParam(), bytes, "m");
  EXPECT_EQ(image.stamp.nanoseconds, 175304000u);
  EXPECT_EQ(image.format, "png");
  EXPECT_EQ(image.data, "bytes");
}

TEST_P(ImageMessages, ACameraIsRead) {
  const std::string bytes =
      MadeCameraInfo(GetParam(), 64, 48, "plumb_bob", {0.1, 0.2, 0.3}, 300.0, 0.1);
  const CameraInfoMessage camera = ReadCameraInfo(GetParam(), bytes, "m");
  EXPECT_EQ(camera.width, 64u);
  EXPECT_EQ(camera.height, 48u);
  EXPECT_EQ(camera.distortion_model, "plumb_bob");
  EXPECT_EQ(camera.distortion, (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(camera.k[0], 300.0);
  EXPECT_EQ(camera.k[2], 31.5);
  EXPECT_EQ(camera.k[8], 1.0);
  EXPECT_EQ(camera.r[4], 1.0);
  EXPECT_EQ(camera.p[3], -30.0);
}

TEST_P(ImageMessages, EveryCutIsRefused) {
  const std::string image = MadeImage(GetParam(), kTime, "mono8", 2, 2, "1234");
  for (size_t kept = 0; kept < image.size(); ++kept) {
    ExpectInputError([&] { ReadRawImage(GetParam(), image.substr(0, kept), "a.bag: m"); },
                     {"a.bag: m "});
  }
}

TEST_P(ImageMessages, AnImageWithFewerBytesThanItsSizeIsRefused) {
  std::string bytes = MadeImage(GetParam(), kTime, "mono8", 2, 2, "1234");
  const size_t at = bytes.find("mono8");
  bytes[at - 12] = 9;  // the height
  ExpectInputError([&] { ReadRawImage(GetParam(), bytes, "a.bag: m"); },
                   {"a.bag: m", "9 rows of 2 bytes", "only 4"});
}

INSTANTIATE_TEST_SUITE_P(Codings, ImageMessages,
                         ::testing::Values(MessageCoding::kCdr, MessageCoding::kRos1));

TEST(FoxgloveMessages, HaveTheContentOfThoseOfRos) {
  constexpr MessageCoding kProtobuf = MessageCoding::kProtobuf;
  const std::string stamp = ProtobufStamp(7'000'000'009) + ProtobufField(9, "camera");
  const std::string raw = stamp + ProtobufNumber(2, uint32_t{3}) + ProtobufNumber(3, uint32_t{2}) +
                          ProtobufField(4, "mono8") + ProtobufNumber(5, uint32_t{4}) +
                          ProtobufField(6, "abcdefgh");
  const RawImageMessage image = ReadRawImage(kProtobuf, raw, "m");
  EXPECT_EQ(image.stamp, (BagTime{7, 9}));
  EXPECT_EQ(image.width, 3u);
  EXPECT_EQ(image.height, 2u);
  EXPECT_EQ(image.step, 4u);
  EXPECT_EQ(image.encoding, "mono8");
  EXPECT_EQ(image.data, "abcdefgh");
  ExpectInputError([&] { ReadRawImage(kProtobuf, raw + ProtobufField(6, "abc"), "m"); },
                   {"m has an image of 2 rows of 4 bytes, but only 3 bytes"});
  const std::string packed = stamp + ProtobufField(2, "bytes") + ProtobufField(3, "jpeg");
  const CompressedImageMessage compressed = ReadCompressedImage(kProtobuf, packed, "m");
  EXPECT_EQ(compressed.stamp, (BagTime{7, 9}));
  EXPECT_EQ(compressed.format, "jpeg");
  EXPECT_EQ(compressed.data, "bytes");
  ByteWriter numbers;
  for (int i = 1; i < 10; ++i) {
    numbers.Put(10.0 * i);
  }
  const std::string info = stamp + ProtobufNumber(2, uint32_t{64}) +
                           ProtobufNumber(3, uint32_t{48}) + ProtobufField(4, "plumb_bob") +
                           ProtobufField(5, numbers.bytes().substr(0, 40)) +
                           ProtobufField(6, numbers.bytes()) + ProtobufField(7, numbers.bytes()) +
                           ProtobufField(8, numbers.bytes());
  const CameraInfoMessage camera = ReadCameraInfo(kProtobuf, info, "m");
  EXPECT_EQ(camera.width, 64u);
  EXPECT_EQ(camera.height, 48u);
  EXPECT_EQ(camera.distortion_model, "plumb_bob");
  EXPECT_EQ(camera.distortion, (std::vector<double>{10, 20, 30, 40, 50}));
  EXPECT_EQ(camera.k[8], 90.0);
  EXPECT_EQ(camera.r[2], 30.0);
  EXPECT_EQ(camera.p[8], 90.0);
  EXPECT_EQ(camera.p[11], 0.0) << "the message has nine numbers";
}

TEST(BagContentTest, DependsOnTheTypeAndTheCoding) {
  const auto content = [](const char* type, MessageCoding coding) {
    return ContentOf({"/a", type, 1, coding});
  };
  EXPECT_EQ(content("sensor_msgs/Image", MessageCoding::kRos1), BagContent::kImage);
  EXPECT_EQ(content("foxglove.CompressedImage", MessageCoding::kProtobuf),
            BagContent::kCompressedImage);
  EXPECT_EQ(content("foxglove.CameraCalibration", MessageCoding::kProtobuf), BagContent::kCamera);
  EXPECT_EQ(content("foxglove.CompressedVideo", MessageCoding::kProtobuf), BagContent::kOther);
  EXPECT_EQ(content("sensor_msgs/Image", MessageCoding::kProtobuf), BagContent::kOther);
}

TEST(BagTimeTest, MicrosecondsAreThoseOfDecimalNumbers) {
  // The double of a text such as "1305031102.175304", for any microseconds.
  for (uint32_t microseconds = 0; microseconds < 1'000'000; microseconds += 997) {
    const std::string text = std::to_string(1'000'000 + microseconds);
    EXPECT_EQ((BagTime{1305031102, microseconds * 1000}.Seconds()),
              std::stod("1305031102." + text.substr(1)));
  }
}

TEST(BagTimeTest, TooManyNanosecondsAreRefused) {
  MadeFields fields(MessageCoding::kCdr);
  fields.Put(uint32_t{1});
  fields.Put(uint32_t{1'000'000'000});
  fields.PutText("camera");
  ExpectInputError([&] { ReadCompressedImage(MessageCoding::kCdr, fields.Message(), "m"); },
                   {"m has a stamp with 1000000000 nanoseconds"});
}

}  // namespace
}  // namespace hullslam

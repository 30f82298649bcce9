// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "masks/mask_fixture.h"
#include "masks/mask_format.h"

namespace hullslam {
namespace {

std::string EncodePng(const cv::Mat& image) {
  std::vector<uchar> bytes;
  cv::imencode(".png", image, bytes);
  return {bytes.begin(), bytes.end()};
}

std::string BigEndian(uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16),
          static_cast<char>(value >> 8), static_cast<char>(value)};
}

std::string Chunk(const std::string& name, const std::string& data) {
  const std::string sealed = name + data;
  uint32_t sum = 0xffffffff;
  for (const char c : sealed) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) {
      sum = (sum & 1) != 0 ? sum >> 1 ^ 0xedb88320 : sum >> 1;
    }
  }
  return BigEndian(static_cast<uint32_t>(data.size())) + sealed + BigEndian(~sum);
}

// An image of 640x480 px with two bits per pixel and this palette of three colours. In each row, 8
// pixels have the number 1, then 8 the number 2, and the others 0. The data are not compressed.
std::string PalettePng(const char (&palette)[10]) {
  std::string rows;
  for (int y = 0; y < 480; ++y) {
    rows += '\0' + std::string(2, '\x55') + std::string(2, '\xaa') + std::string(156, '\0');
  }
  std::string packed = "\x78\x01";
  uint32_t a = 1;
  uint32_t b = 0;
  for (const char c : rows) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  for (size_t at = 0; at < rows.size(); at += 60000) {
    const std::string part = rows.substr(at, 60000);
    const auto size = static_cast<uint32_t>(part.size());
    packed += at + 60000 >= rows.size() ? '\1' : '\0';
    for (const uint32_t word : {size, ~size}) {
      packed += {static_cast<char>(word), static_cast<char>(word >> 8)};
    }
    packed += part;
  }
  return "\x89PNG\r\n\x1a\n" +
         Chunk("IHDR", BigEndian(640) + BigEndian(480) + std::string("\2\3\0\0\0", 5)) +
         Chunk("PLTE", std::string(palette, 9)) + Chunk("IDAT", packed + BigEndian(b << 16 | a)) +
         Chunk("IEND", "");
}

class LabelPngTest : public MaskFixture {
 protected:
  LabelPngTest() : MaskFixture("label-png") {
    labels_(cv::Rect(100, 50, 40, 30)).setTo(7);
    labels_(cv::Rect(0, 400, 20, 80)).setTo(300);
    labels_(cv::Rect(200, 50, 10, 10)).setTo(300);
    Write("1.5.png", EncodePng(labels_));
    Write("classes.json", R"({"7": "cup", "300": {"class": "tv", "score": 0.75}})");
  }

  void ExpectRefusedClasses(const std::string& json, const std::vector<std::string>& parts) const {
    Write("classes.json", json);
    std::vector<std::string> all = {Path("classes.json").string() + ": "};
    all.insert(all.end(), parts.begin(), parts.end());
    ExpectRefusal(all);
  }

  cv::Mat labels_ = cv::Mat::zeros(480, 640, CV_16UC1);
};

TEST_F(LabelPngTest, InstancesAreOrderedByNumber) {
  const FrameMasks frame = ReadFrame(0);
  ASSERT_EQ(frame.masks.size(), 2U);
  EXPECT_EQ(frame.masks[0].label, "cup");
  EXPECT_EQ(frame.masks[0].score, 1.0);
  ASSERT_EQ(frame.masks[0].outlines.size(), 1U);
  EXPECT_DOUBLE_EQ(Area(frame.masks[0].outlines[0]), 40.0 * 30.0 - 0.5);
  EXPECT_EQ(frame.masks[1].label, "tv");
  EXPECT_EQ(frame.masks[1].score, 0.75);
  ASSERT_EQ(frame.masks[1].outlines.size(), 2U);  // the larger part first
  EXPECT_DOUBLE_EQ(Area(frame.masks[1].outlines[0]), 20.0 * 80.0 - 0.5);
  EXPECT_DOUBLE_EQ(Area(frame.masks[1].outlines[1]), 100.0 - 0.5);
  for (const Eigen::Vector2d& point : frame.masks[1].outlines[1]) {
    EXPECT_TRUE(point.x() >= 199.5 && point.x() <= 209.5 && point.y() >= 49.5) << point;
  }
  EXPECT_TRUE(ReadFrame(1).is_missing);
}

TEST_F(LabelPngTest, GreyImagesOfEightBitsAreRead) {
  cv::Mat small = cv::Mat::zeros(480, 640, CV_8UC1);
  small(cv::Rect(100, 50, 40, 30)).setTo(7);
  Write("1.5.png", EncodePng(small));
  ASSERT_EQ(ReadFrame(0).masks.size(), 1U);
  EXPECT_EQ(ReadFrame(0).masks[0].label, "cup");
}

// Python writes such images (PIL, mode P), as in the data set DAVIS: the palette is black, red,
// green, and the image has the numbers 1 and 2.
TEST_F(LabelPngTest, TheNumbersOfAPaletteAreRead) {
  Write("classes.json", R"({"1": "cup", "2": "tv"})");
  Write("1.5.png", PalettePng("\0\0\0\x80\0\0\0\x80\0"));
  const FrameMasks frame = ReadFrame(0);
  ASSERT_EQ(frame.masks.size(), 2U);
  EXPECT_EQ(frame.masks[0].label, "cup");
  EXPECT_DOUBLE_EQ(Area(frame.masks[0].outlines[0]), 8.0 * 480.0 - 0.5);
  EXPECT_EQ(frame.masks[1].label, "tv");
  Write("1.5.png", PalettePng("\0\0\0\x80\0\0\x80\0\0"));
  ExpectRefusal({"1.5.png: two entries of its palette have the same colour"});
}

// As SAM 2 numbers them. What the numbers of images say comes before their order.
TEST_F(LabelPngTest, FilesMayBeNumbered) {
  std::filesystem::rename(Path("1.5.png"), Path("00000.png"));
  frames_ = {{"1.5", 0}, {"2.5", 1}, {"3.5", 12}};
  EXPECT_EQ(ReadFrame(0).masks.size(), 2U);
  EXPECT_TRUE(ReadFrame(1).is_missing);
  EXPECT_TRUE(ReadFrame(2).is_missing);
  frames_ = {{"000002", 0}, {"000000", 7}};
  EXPECT_TRUE(ReadFrame(0).is_missing);
  EXPECT_EQ(ReadFrame(1).masks.size(), 2U);
}

// Files from 1 may be those of the frames from 0, or lack the first one: one frame off, all masks
// would be wrong.
TEST_F(LabelPngTest, FilesThatAreNotNumberedFromZeroAreThoseOfNoFrame) {
  std::filesystem::rename(Path("1.5.png"), Path("00001.png"));
  ExpectRefusal({"no masks (label-png)", "there is '00001.png'"});
  Write("00000.png", EncodePng(labels_));
  EXPECT_FALSE(ReadFrame(1).is_missing);
  Write("preview.png", EncodePng(labels_));
  ExpectRefusal({"no masks (label-png)"});
}

TEST_F(LabelPngTest, IsDetected) {
  format_ = "";
  EXPECT_EQ(Open()->format(), "label-png");
}

TEST_F(LabelPngTest, AFrameMayHaveItsOwnClasses) {
  Write("classes.json", R"({"7": "cup", "300": "tv", "frames": {"1.5": {"300": "laptop"}}})");
  EXPECT_EQ(ReadFrame(0).masks.at(0).label, "cup");
  EXPECT_EQ(ReadFrame(0).masks.at(1).label, "laptop");
}

TEST_F(LabelPngTest, SinglePixelsAreLeftOutAndCounted) {
  labels_.setTo(0);
  labels_.at<uint16_t>(7, 9) = 7;
  Write("1.5.png", EncodePng(labels_));
  EXPECT_TRUE(ReadFrame(0).masks.empty());
  EXPECT_EQ(ReadFrame(0).without_area, 1U);
}

TEST_F(LabelPngTest, OtherImagesAreRefused) {
  const std::string path = Path("1.5.png");
  Write("1.5.png", EncodePng(cv::Mat::zeros(480, 640, CV_8UC3)));
  ExpectRefusal({path, "label image", "16 bits"});
  Write("1.5.png", EncodePng(cv::Mat::zeros(240, 320, CV_16UC1)));
  ExpectRefusal({path, "320x240", "640x480"});
  Write("1.5.png", EncodePng(labels_).substr(0, 300));
  ExpectRefusal({path, "cut off"});
  Write("1.5.png", "");
  ExpectRefusal({path, "empty"});
}

TEST_F(LabelPngTest, InstancesWithoutAClassAreRefused) {
  Write("classes.json", R"({"300": "tv"})");
  ExpectRefusal({Path("1.5.png"), "instance 7 is not in classes.json"});
}

TEST_F(LabelPngTest, BrokenClassesAreRefused) {
  ExpectRefusedClasses("cup", {"no valid JSON", "line 1, column 1"});
  ExpectRefusedClasses("[\"cup\"]", {"expected an object"});
  ExpectRefusedClasses(R"({"seven": "cup"})", {"key 'seven'", "1 to 65535"});
  ExpectRefusedClasses(R"({"0": "cup"})", {"key '0'", "1 to 65535"});
  ExpectRefusedClasses(R"({"65536": "cup"})", {"key '65536'", "1 to 65535"});
  ExpectRefusedClasses(R"({"7": 41})", {"instance 7 is 41", "\"cup\""});
  ExpectRefusedClasses(R"({"7": {"class": "cup", "score": 2}})", {"score of instance 7 is 2"});
  ExpectRefusedClasses(R"({"7": "cup", "frames": 3})", {"frames is 3"});
  ExpectRefusedClasses(R"({"frames": {"1.5": ["cup"]}})", {"frames.1.5 is [\"cup\"]"});
  std::filesystem::remove(Path("classes.json"));
  ExpectRefusal({Path("classes.json")});
}

TEST_F(LabelPngTest, TooManyInstancesAreRefused) {
  std::string classes = "{\"1\": \"cup\"";
  for (int i = 0; i < 20'000; ++i) {
    labels_.at<uint16_t>(2 * (i / 300), 2 * (i % 300)) = static_cast<uint16_t>(i + 1);
    classes += ", \"" + std::to_string(i + 1) + "\": \"cup\"";
  }
  Write("1.5.png", EncodePng(labels_));
  Write("classes.json", classes + ", \"300\": \"tv\"}");
  ExpectInputError([&] { ReadFrame(0); }, {Path("1.5.png"), "too many instances", "1000"});
}

}  // namespace
}  // namespace hullslam

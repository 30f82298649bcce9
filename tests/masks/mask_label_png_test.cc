// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_label_png.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "masks/mask_fixture.h"

namespace hullslam {
namespace {

std::string EncodePng(const cv::Mat& image) {
  std::vector<uchar> bytes;
  cv::imencode(".png", image, bytes);
  return {bytes.begin(), bytes.end()};
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
  Write("1.5.png", EncodePng(cv::Mat::zeros(480, 640, CV_8UC1)));
  ExpectRefusal({path, "8 bits", "label image", "16 bits"});
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

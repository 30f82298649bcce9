// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "masks/mask_fixture.h"
#include "masks/mask_format.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

class BoxesTest : public MaskFixture {
 protected:
  BoxesTest() : MaskFixture("boxes") {}

  void ExpectRefusedLine(const std::string& line, const std::vector<std::string>& parts) const {
    Write("1.5.txt", line + '\n');
    std::vector<std::string> all = {Path("1.5.txt").string() + ":1: "};
    all.insert(all.end(), parts.begin(), parts.end());
    ExpectRefusal(all);
  }
};

TEST_F(BoxesTest, BoxesStartAtXAndY) {
  Write("1.5.txt", "73 173 138 46 70 0.5789\n56 16 256 220 215 1\n");
  const FrameMasks frame = ReadFrame(0);
  ASSERT_EQ(frame.masks.size(), 2U);
  const InstanceMask& book = frame.masks[0];
  EXPECT_EQ(book.label, "book");
  EXPECT_EQ(book.score, 0.5789);
  EXPECT_EQ(book.shape, MaskShape::kBox);
  // 46 x 70 pixels, with centres from (173, 138) to (218, 207).
  EXPECT_EQ(book.outlines, (std::vector<std::vector<Eigen::Vector2d>>{
                               {{172.5, 137.5}, {218.5, 137.5}, {218.5, 207.5}, {172.5, 207.5}}}));
}

TEST_F(BoxesTest, BoxesAreClippedAtTheBorder) {
  Write("1.5.txt", "0 -20 -20 1000 1000 0.5\n");
  const auto outline = ReadFrame(0).masks.at(0).outlines.at(0);
  EXPECT_EQ(outline[0], Eigen::Vector2d(-0.5, -0.5));
  EXPECT_EQ(outline[2], Eigen::Vector2d(639.5, 479.5));
}

TEST_F(BoxesTest, BoxesWithoutAreaInTheImageAreLeftOutAndCounted) {
  Write("1.5.txt", "0 10 10 0 50 0.5\n0 700 10 50 50 0.5\n0 10 10 5 5 0.5\n");
  EXPECT_EQ(ReadFrame(0).masks.size(), 1U);
  EXPECT_EQ(ReadFrame(0).without_area, 2U);
}

TEST_F(BoxesTest, MalformedLinesAreRefused) {
  ExpectRefusedLine("73 173 138 46 70", {"5 column(s)", "expected 6"});
  ExpectRefusedLine("73 173 138 46 70 0.5 1", {"7 column(s)"});
  ExpectRefusedLine("80 173 138 46 70 0.5", {"class is '80'"});
  ExpectRefusedLine("73 nan 138 46 70 0.5", {"x is 'nan'"});
  ExpectRefusedLine("73 173 138 -46 70 0.5", {"width is '-46'", ">= 0"});
  ExpectRefusedLine("73 173 138 46 -1 0.5", {"height is '-1'", ">= 0"});
  ExpectRefusedLine("73 1e300 138 46 70 0.5", {"x is '1e300'", "from -1e+06 to 1e+06"});
  ExpectRefusedLine("73 173 138 46 1e308 0.5", {"height is '1e308'", "1e+06"});
  ExpectRefusedLine("73 173 138 46 70 50", {"confidence is '50'", "from 0 to 1"});
}

// `yolo detect track save_txt` adds the number of a track, `save_conf` the confidence before it.
TEST_F(BoxesTest, NumbersOfTracksAreNoConfidences) {
  for (const std::string format : {"boxes", ""}) {
    format_ = format;
    Write("1.5.txt", "41 0.5 0.5 0.1 0.1 0.75 3\n62 0.5 0.5 0.1 0.1 0.5 1\n");
    FrameMasks frame = ReadFrame(0);
    ASSERT_EQ(frame.masks.size(), 2U);
    EXPECT_EQ(frame.masks[0].score, 0.75);
    EXPECT_EQ(frame.masks[1].score, 0.5);
    Write("1.5.txt", "41 0.5 0.5 0.1 0.1 3\n62 0.5 0.5 0.1 1\n");
    frame = ReadFrame(0);
    ASSERT_EQ(frame.masks.size(), 2U);
    EXPECT_EQ(frame.masks[0].score, 1.0);
    EXPECT_EQ(frame.masks[1].score, 1.0);
  }
}

TEST_F(BoxesTest, BothFormsAreDetected) {
  format_ = "";
  Write("1.5.txt", "73 173 138 46 70 0.5789\n");
  EXPECT_EQ(Open()->format(), "boxes");
  Write("1.5.txt", "73 0.5 0.5 0.1 0.1 0.5789\n");
  EXPECT_EQ(Open()->format(), "boxes");
  Write("1.5.txt", "73 0.5 0.5 0.1 0.1\n");
  EXPECT_EQ(Open()->format(), "boxes");
}

TEST_F(BoxesTest, BoxesOfYoloAreSharesOfTheImageAroundTheirCentre) {
  Write("1.5.txt", "41 0.5 0.25 0.1 0.5 0.75\n0 0.95 0.9 0.2 0.4\n");
  const FrameMasks frame = ReadFrame(0);
  ASSERT_EQ(frame.masks.size(), 2U);
  EXPECT_EQ(frame.masks[0].label, "cup");
  EXPECT_EQ(frame.masks[0].score, 0.75);
  EXPECT_EQ(frame.masks[0].shape, MaskShape::kBox);
  // From 288 to 352 and from 0 to 240 between the edges of pixels.
  const auto& outline = frame.masks[0].outlines.at(0);
  EXPECT_NEAR((outline.at(0) - Eigen::Vector2d(287.5, -0.5)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((outline.at(2) - Eigen::Vector2d(351.5, 239.5)).norm(), 0.0, 1e-9);
  // Without a confidence the score is 1. The box is clipped at the border.
  EXPECT_EQ(frame.masks[1].score, 1.0);
  const auto& clipped = frame.masks[1].outlines.at(0);
  EXPECT_NEAR((clipped.at(0) - Eigen::Vector2d(543.5, 335.5)).norm(), 0.0, 1e-9);
  EXPECT_EQ(clipped.at(2), Eigen::Vector2d(639.5, 479.5));
}

TEST_F(BoxesTest, TheFirstBoxDecidesTheFormOfAll) {
  Write("1.5.txt", "");
  Write("2.5.txt", "41 0.5 0.5 0.1 0.1\n41 300 200 20 10 0.5\n");
  ExpectRefusal({Path("2.5.txt").string() + ":2: ", "x is '300'", "from 0 to 1", "the first box"});
  Write("2.5.txt", "41 300 200 20 10 0.5\n41 0 0 1 1 0.5\n");
  EXPECT_EQ(ReadFrame(1).masks.size(), 2U) << "the second box is a single pixel";
}

TEST_F(BoxesTest, MalformedLinesOfYoloAreRefused) {
  ExpectRefusedLine("41 0.5 0.5 0.1 0.1 nan", {"confidence"});
  Write("1.5.txt", "");
  Write("2.5.txt", "41 0.5 0.5 0.1 0.1\n41 0.5 0.5 0.1\n");
  ExpectRefusal({"2.5.txt:2: 4 column(s), expected 5 to 7"});
  Write("2.5.txt", "41 0.5 0.5 0.1 0.1\n41 0.5 0.5 -0.1 0.1\n");
  ExpectRefusal({"2.5.txt:2: width is '-0.1'"});
}

TEST(BoxesData, RealBoxesAreRead) {
  const auto data = FindTestData("fr3_office_boxes");
  if (!data) {
    GTEST_SKIP() << "fr3_office_boxes is not on this machine; set HULLSLAM_DATA";
  }
  const std::vector<MaskFrame> frames = {{"1341847980.722988", 0}};
  const auto source =
      OpenMasks({.path = *data / "boxes", .format = {}, .width = 640, .height = 480}, frames);
  EXPECT_EQ(source->format(), "boxes");
  EXPECT_EQ(source->Read(frames[0]).masks.at(0).label, "book");
}

}  // namespace
}  // namespace hullslam

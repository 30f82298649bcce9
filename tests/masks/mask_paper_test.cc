// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "masks/mask_fixture.h"
#include "masks/mask_format.h"

namespace hullslam {
namespace {

class PaperTest : public MaskFixture {
 protected:
  PaperTest() : MaskFixture("paper") { frames_ = {{"1.5", 0}, {"2.5", 17}}; }

  void ExpectRefusedLine(const std::string& line, const std::vector<std::string>& parts) const {
    Write("000000.txt", line + '\n');
    std::vector<std::string> all = {Path("000000.txt").string() + ":1: "};
    all.insert(all.end(), parts.begin(), parts.end());
    ExpectRefusal(all);
  }
};

const char* const kPixelTriangle = "10 20 300.5 20 10 400";

TEST_F(PaperTest, FilesAreNamedByFrameNumberAndUsePixels) {
  Write("segmentation_txt/000000.txt", std::string("0 5 cup 0.5 ") + kPixelTriangle + '\n');
  Write("segmentation_txt/000017.txt", std::string("3 -1 62 1 ") + kPixelTriangle + '\n');
  const InstanceMask cup = ReadFrame(0).masks.at(0);
  EXPECT_EQ(cup.label, "cup");
  EXPECT_EQ(cup.score, 0.5);
  EXPECT_EQ(
      cup.outlines,
      (std::vector<std::vector<Eigen::Vector2d>>{{{10.0, 20.0}, {300.5, 20.0}, {10.0, 400.0}}}));
  EXPECT_EQ(ReadFrame(1).masks.at(0).label, "tv");
}

TEST_F(PaperTest, OuterAndInnerFolderAreAccepted) {
  Write("segmentation_txt/000000.txt", std::string("0 5 41 0.5 ") + kPixelTriangle + '\n');
  format_ = "";
  EXPECT_EQ(Open()->format(), "paper");
  EXPECT_EQ(Open("segmentation_txt")->format(), "paper");
  EXPECT_EQ(ReadFrame(0, "segmentation_txt").masks.size(), 1U);
}

TEST_F(PaperTest, MalformedLinesAreRefused) {
  const std::string triangle = kPixelTriangle;
  ExpectRefusedLine("0 5 cup", {"3 column(s)", "polygon"});
  ExpectRefusedLine("0 5 cup 0.5 " + triangle + " 7", {"11 column(s)"});
  ExpectRefusedLine("a 5 cup 0.5 " + triangle, {"instance is 'a'"});
  ExpectRefusedLine("0 b cup 0.5 " + triangle, {"track is 'b'"});
  ExpectRefusedLine("0 5 80 0.5 " + triangle, {"class is '80'"});
  ExpectRefusedLine("0 5 cup 2 " + triangle, {"confidence is '2'"});
  ExpectRefusedLine("0 5 cup 0.5 10 20 nan 20 10 400", {"x is 'nan'"});
  ExpectRefusedLine("0 5 cup 0.5 10 20 642 20 10 400",
                    {"point (642, 20) in column 7", "outside the image of 640x480 px"});
}

TEST_F(PaperTest, LinesWithoutAnOutlineAreLeftOutAndCounted) {
  Write("000000.txt", "0 5 cup 0.5 10 20 30 40\n1 6 cup 0.5\n");
  EXPECT_TRUE(ReadFrame(0).masks.empty());
  EXPECT_EQ(ReadFrame(0).without_area, 2U);
}

}  // namespace
}  // namespace hullslam

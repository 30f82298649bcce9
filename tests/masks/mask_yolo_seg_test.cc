// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "hullslam/sequences/tum_sequence.h"
#include "masks/mask_fixture.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

class YoloSegTest : public MaskFixture {
 protected:
  YoloSegTest() : MaskFixture("yolo-seg") {}

  // Expects that the first frame is refused if this line follows a comment in its file.
  void ExpectRefusedLine(const std::string& line, const std::vector<std::string>& parts) const {
    Write("1.5.txt", "# masks\n" + line + '\n');
    std::vector<std::string> all = {Path("1.5.txt").string() + ":2: "};
    all.insert(all.end(), parts.begin(), parts.end());
    ExpectRefusal(all);
  }
};

const char* const kShareTriangle = "0.25 0.25 0.5 0.25 0.25 0.75";

TEST_F(YoloSegTest, CoordinatesArePixelCentresInFractionsOfTheSize) {
  Write("1.5.txt", std::string("41 ") + kShareTriangle + " 0.9\r\n62 " + kShareTriangle + '\n');
  const FrameMasks frame = ReadFrame(0);
  ASSERT_EQ(frame.masks.size(), 2U);
  EXPECT_FALSE(frame.is_missing);
  const InstanceMask& cup = frame.masks[0];
  EXPECT_EQ(cup.label, "cup");
  EXPECT_EQ(cup.score, 0.9);
  EXPECT_EQ(cup.shape, MaskShape::kContour);
  EXPECT_EQ(cup.outlines, (std::vector<std::vector<Eigen::Vector2d>>{
                              {{160.0, 120.0}, {320.0, 120.0}, {160.0, 360.0}}}));
  EXPECT_EQ(frame.masks[1].label, "tv");
  EXPECT_EQ(frame.masks[1].score, 1.0);  // the score of a line without a confidence
}

TEST_F(YoloSegTest, FramesWithoutFileAreMissingButEmptyFilesAreNot) {
  Write("1.5.txt", "");
  EXPECT_FALSE(ReadFrame(0).is_missing);
  EXPECT_TRUE(ReadFrame(0).masks.empty());
  EXPECT_TRUE(ReadFrame(1).is_missing);
  EXPECT_EQ(CheckMasks(*Open(), frames_).missing, 1U);
}

TEST_F(YoloSegTest, PointsBeyondTheBorderByRoundingAreAccepted) {
  Write("1.5.txt", "0 -0.0007 0.0 1.0007 0.0 0.5 1.001\n");
  EXPECT_NEAR(ReadFrame(0).masks.at(0).outlines[0][1].x(), 640.448, 1e-9);
}

TEST_F(YoloSegTest, OutlinesWithoutAreaAreLeftOutAndCounted) {
  Write("1.5.txt", "41 0.1 0.1 0.2 0.2 0.3 0.3\n41 0.1 0.1 0.1 0.1 0.1 0.1\n");
  EXPECT_TRUE(ReadFrame(0).masks.empty());
  EXPECT_EQ(ReadFrame(0).without_area, 2U);
}

// About one percent of the outlines of real networks cross themselves. Their hulls are still
// usable.
TEST_F(YoloSegTest, OutlinesMayCrossThemselves) {
  Write("1.5.txt", "41 0.1 0.1 0.5 0.5 0.5 0.1 0.1 0.6\n");
  EXPECT_EQ(ReadFrame(0).masks.at(0).outlines[0].size(), 4U);
}

TEST_F(YoloSegTest, ClassesFileNamesTheClasses) {
  Write("classes.txt", "robot\nred ball\r\n\n");
  Write("1.5.txt", std::string("1 ") + kShareTriangle + '\n');
  EXPECT_EQ(ReadFrame(0).masks.at(0).label, "red ball");
  ExpectRefusedLine(std::string("2 ") + kShareTriangle, {"class is '2'", "from 0 to 1"});
}

TEST_F(YoloSegTest, MalformedLinesAreRefused) {
  const std::string triangle = kShareTriangle;
  ExpectRefusedLine("cup " + triangle, {"class is 'cup'", "a finite number"});
  ExpectRefusedLine("80 " + triangle, {"class is '80'", "from 0 to 79"});
  ExpectRefusedLine("-1 " + triangle, {"class is '-1'", "from 0 to 79"});
  ExpectRefusedLine("1.5 " + triangle, {"class is '1.5'", "an integer"});
  ExpectRefusedLine("1e300 " + triangle, {"class is '1e+300'", "an integer"});
  ExpectRefusedLine("41 nan 0.1 0.2 0.2 0.3 0.1", {"x is 'nan'", "a finite number"});
  ExpectRefusedLine("41 0.1 inf 0.2 0.2 0.3 0.1", {"y is 'inf'", "a finite number"});
  ExpectRefusedLine("41 0.1 0.1 1.2 0.2 0.3 0.1", {"x is '1.2' in column 4", "from 0 to 1"});
  ExpectRefusedLine("41 0.1 -0.1 0.2 0.2 0.3 0.1", {"y is '-0.1' in column 3", "from 0 to 1"});
  ExpectRefusedLine("41 " + triangle + " 1.5", {"confidence is '1.5'", "from 0 to 1"});
  ExpectRefusedLine("41 " + triangle + " high", {"confidence is 'high'"});
}

// Networks write lines without an outline, or with one of a point or two, for masks without area.
TEST_F(YoloSegTest, LinesWithoutAnOutlineAreLeftOutAndCounted) {
  const std::string triangle = kShareTriangle;
  Write("1.5.txt", "67 0.27\n41 " + triangle + " 0.9\n41\n41 0.1 0.1 0.2 0.2\n" +
                       "41 0.1 0.1 0.2 0.2 0.9\n41 0.5 0.5 0.7\n");
  for (const std::string format : {"yolo-seg", ""}) {  // the first line does not hide the format
    format_ = format;
    const FrameMasks frame = ReadFrame(0);
    EXPECT_EQ(frame.masks.size(), 1U);
    EXPECT_EQ(frame.without_area, 5U);
    EXPECT_EQ(frame.rows, std::vector<size_t>{1});
    EXPECT_EQ(CheckMasks(*Open(), frames_).without_area, 5U);
  }
}

// `yolo track save_txt` writes the number of the track behind each outline, `save_conf` the
// confidence between them.
TEST_F(YoloSegTest, NumbersOfTracksAreNeitherPointsNorConfidences) {
  const std::string triangle = kShareTriangle;
  format_ = "";
  for (const std::string& tracks : {std::string("1 1"), std::string("1 2"), std::string("12 13")}) {
    const size_t blank = tracks.find(' ');
    const std::string first = tracks.substr(0, blank);
    const std::string second = tracks.substr(blank + 1);
    Write("1.5.txt", "41 " + triangle + " 0.9 " + first + "\n62 " + triangle + " 0.8 " + second +
                         "\n64 " + triangle + " 0.7\n");  // without a track in this frame
    FrameMasks frame = ReadFrame(0);
    ASSERT_EQ(frame.masks.size(), 3U) << tracks;
    EXPECT_EQ(frame.masks[0].outlines[0].size(), 3U) << tracks;
    EXPECT_EQ(frame.masks[0].score, 0.9);
    EXPECT_EQ(frame.masks[1].score, 0.8);
    EXPECT_EQ(frame.masks[2].score, 0.7);
    Write("1.5.txt", "41 " + triangle + ' ' + first + "\n62 " + triangle + ' ' + second + '\n');
    frame = ReadFrame(0);
    ASSERT_EQ(frame.masks.size(), 2U) << tracks;
    EXPECT_EQ(frame.masks[1].outlines[0].size(), 3U);
    EXPECT_EQ(frame.masks[1].score, 1.0);
  }
}

// One outline that ends elsewhere shows that the last column is a coordinate.
TEST_F(YoloSegTest, APointAtTheBorderIsNoTrack) {
  const std::string triangle = kShareTriangle;
  Write("1.5.txt", "41 " + triangle + " 0.9 1\n41 " + triangle + "\n");
  EXPECT_EQ(ReadFrame(0).masks.at(0).outlines[0].size(), 4U);
  Write("1.5.txt", "41 " + triangle + " 95\n41 " + triangle + " 0.5\n");
  ExpectRefusal({"1.5.txt:1: confidence is '95'"});
}

TEST_F(YoloSegTest, LabelsOfAVideoAreFoundByTheNamesOfUltralytics) {
  const std::string line = std::string("41 ") + kShareTriangle + '\n';
  Write("kitchen_1.txt", line);
  Write("kitchen_2.txt", line + line);
  folder_.Write("kitchen.mp4", "video");
  ImageSequence video;
  for (size_t i = 0; i < 3; ++i) {
    const std::string name = "00000" + std::to_string(i);
    video.frames.push_back(
        {0.1 * static_cast<double>(i), folder_.path() / "kitchen.mp4" / name, {}, i});
  }
  frames_ = MaskFrames(video);
  EXPECT_EQ(ReadFrame(0).masks.size(), 1U);
  EXPECT_EQ(ReadFrame(1).masks.size(), 2U);
  EXPECT_TRUE(ReadFrame(2).is_missing);
  Write("000001.txt", line + line + line);
  EXPECT_EQ(ReadFrame(1).masks.size(), 3U);
}

TEST_F(YoloSegTest, HugeFilesAreRefused) {
  std::string many;
  for (int i = 0; i < 10'001; ++i) {
    many += std::string("0 ") + kShareTriangle + '\n';
  }
  Write("1.5.txt", many);
  ExpectRefusal({"1.5.txt:1001: ", "too many instances", "1000"});
  Write("1.5.txt", std::string(16'000'001, '1'));
  ExpectRefusal({"1.5.txt", "16000001 bytes", "at most 16 MB"});
}

TEST(YoloSegData, RealMasksAreRead) {
  const auto data = FindTestData("fr1_xyz");
  if (!data) {
    GTEST_SKIP() << "fr1_xyz is not on this machine; set HULLSLAM_DATA";
  }
  const std::vector<MaskFrame> frames = MaskFrames(OpenTumSequence(*data));
  const auto source = OpenMasks(
      {.path = *data / "masks-yolo8n-seg", .format = {}, .width = 640, .height = 480}, frames);
  EXPECT_EQ(source->format(), "yolo-seg");
  EXPECT_EQ(CheckMasks(*source, frames).missing, 0U);
  const FrameMasks first = source->Read({"1305031102.175304", 0});
  ASSERT_EQ(first.masks.size(), 11U);
  EXPECT_EQ(first.masks[1].label, "person");
  EXPECT_EQ(first.masks[1].score, 0.9176);
  EXPECT_EQ(first.masks[1].outlines[0].front(), Eigen::Vector2d(252.0, 0.0));
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/mask_source.h"

#include <gtest/gtest.h>

#include <string>

#include "io/mask_fixture.h"

namespace hullslam {
namespace {

const char* const kYoloSeg = "41 0.25 0.25 0.5 0.25 0.25 0.75 0.9\n";

// Masks whose format is detected.
class MaskSourceTest : public MaskFixture {
 protected:
  MaskSourceTest() : MaskFixture("") {}
};

TEST(MaskFrames, HaveTheStemsAndNumbersOfTheImages) {
  TumSequence sequence;
  sequence.frames = {{1.5, "a/rgb/1.500000.png", "", 3}, {2.5, "/b/rgb/0007.JPG", "", 4}};
  const std::vector<MaskFrame> frames = MaskFrames(sequence);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].stem, "1.500000");
  EXPECT_EQ(frames[0].number, 3U);
  EXPECT_EQ(frames[1].stem, "0007");
}

TEST_F(MaskSourceTest, FormatIsDetectedFromTheFirstLineOfAnyFile) {
  Write("0.5.txt", "");
  Write("1.5.txt", "# nothing\n\n");
  Write("3.5.txt", kYoloSeg);
  EXPECT_EQ(Open()->format(), "yolo-seg");
}

TEST_F(MaskSourceTest, MissingAndEmptyPathsAreRefused) {
  ExpectRefusal({Path("none").string(), "no such"}, "none");
  std::filesystem::create_directories(Path());
  ExpectRefusal({Path().string(), "is not clear, none fits", "--masks-format", "yolo-seg"});
  format_ = "yolo-seg";
  ExpectRefusal({Path().string(), "there is nothing", "'1.5'"});
}

TEST_F(MaskSourceTest, SeveralFormatsInOneFolderAreRefused) {
  Write("1.5.txt", kYoloSeg);
  Write("1.5.png", "");
  Write("classes.json", "{}");
  ExpectRefusal({"is not clear, yolo-seg and label-png fit", "--masks-format"});
}

TEST_F(MaskSourceTest, FilesOfOtherKindsAreRefused) {
  folder_.Write("masks/file", "some text");
  ExpectRefusal({Path("file").string(), "none fits"}, "file");
}

TEST_F(MaskSourceTest, EveryFormatIsNamed) {
  EXPECT_EQ(MaskFormatNames(), (std::vector<std::string>{"yolo-seg", "coco", "label-png", "paper",
                                                         "oa-slam", "boxes"}));
  Write("1.5.txt", "");
  for (const char* const name : {"yolo-seg", "paper", "boxes"}) {
    format_ = name;
    frames_ = {{name == std::string("paper") ? "x" : "1.5", 0}};
    Write("000000.txt", "");
    EXPECT_EQ(Open()->format(), name);
  }
}

TEST_F(MaskSourceTest, FolderFormatsOfAFileAndFileFormatsOfAFolderAreRefused) {
  folder_.Write("masks/file", "[]");
  for (const char* const name : {"yolo-seg", "paper", "boxes", "label-png"}) {
    format_ = name;
    ExpectRefusal({Path("file").string()}, "file");
  }
  for (const char* const name : {"coco", "oa-slam"}) {
    format_ = name;
    ExpectRefusal({Path().string()});
  }
}

TEST_F(MaskSourceTest, UnknownFormatIsRefused) {
  Write("1.5.txt", kYoloSeg);
  format_ = "yolo";
  ExpectRefusal({"--masks-format is 'yolo'", "yolo-seg"});
}

TEST_F(MaskSourceTest, MasksOfOtherFramesAreRefusedWithAnExample) {
  Write("0001.txt", kYoloSeg);
  Write("0002.txt", kYoloSeg);
  ExpectRefusal({Path().string(), "any of the 2 frames", "'0001.txt'", "'1.5'"});
}

}  // namespace
}  // namespace hullslam

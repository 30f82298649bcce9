// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/masks/open_masks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "masks/mask_fixture.h"

namespace hullslam {
namespace {

const char* const kYoloSeg = "41 0.25 0.25 0.5 0.25 0.25 0.75 0.9\n";

// Masks whose format is detected.
class OpenMasksTest : public MaskFixture {
 protected:
  OpenMasksTest() : MaskFixture("") {}
};

TEST_F(OpenMasksTest, FormatIsDetectedFromTheFirstLineOfAnyFile) {
  Write("0.5.txt", "");
  Write("1.5.txt", "# nothing\n\n");
  Write("3.5.txt", kYoloSeg);
  EXPECT_EQ(Open()->format(), "yolo-seg");
}

TEST_F(OpenMasksTest, MissingAndEmptyPathsAreRefused) {
  ExpectRefusal({Path("none").string(), "no such"}, "none");
  std::filesystem::create_directories(Path());
  ExpectRefusal({Path().string(), "the folder is empty"});
  format_ = "yolo-seg";
  ExpectRefusal({Path().string(), "there is nothing", "'1.5'"});
}

TEST_F(OpenMasksTest, SeveralFormatsInOneFolderAreRefused) {
  Write("1.5.txt", kYoloSeg);
  Write("1.5.png", "");
  Write("classes.json", "{}");
  ExpectRefusal({"is not clear, yolo-seg and label-png fit", "--masks-format"});
}

TEST_F(OpenMasksTest, AFolderWithoutMasksIsDescribed) {
  Write("notes.md", "");
  ExpectRefusal({Path().string(), "has neither text files nor PNG or JSON files"});
  Write("1.5.npz", "");
  ExpectRefusal({Path().string(), "has .npz files", "label-png"});
  Write("masks.json", "{}");
  ExpectRefusal({"has a JSON file that is not named as a frame", "give the path of the file"});
  Write("1.5.png", "");
  ExpectRefusal({"PNG files but no classes.json", "label-png"});
  Write("classes.txt", "cup");
  Write("1.5.txt", "");
  Write("2.5.txt", "# nothing\n");
  ExpectRefusal({"all 2 text files are empty", "--masks-format"});
}

TEST_F(OpenMasksTest, LinesOfNoFormatAreShown) {
  Write("1.5.txt", "");
  Write("2.5.txt", "41 17 300\n");
  ExpectRefusal({Path().string(), "'41 17 300' in 2.5.txt fits no format of masks"});
  Write("2.5.txt", "a b c d e f g h i j\n");
  ExpectRefusal({"'a b c d e f g h ...' in 2.5.txt"});
}

TEST_F(OpenMasksTest, FilesThatAreNoMasksAreDescribed) {
  folder_.Write("masks/file", "some text");
  ExpectRefusal({Path("file").string(), "is no valid JSON", "line 1"}, "file");
  folder_.Write("masks/empty.json", "");
  ExpectRefusal({"is no valid JSON"}, "empty.json");
  folder_.Write("masks/cut.json", "[{\"image_");
  ExpectRefusal({Path("cut.json").string(), "is no valid JSON", "column 10"}, "cut.json");
  folder_.Write("masks/cut_later.json", "[{\"image_id\": \"1.5\", \"category");
  ExpectRefusal({"is no valid JSON"}, "cut_later.json");
  folder_.Write("masks/other.json", "{\"objects\": []}");
  ExpectRefusal({"is JSON, but has none of the keys 'annotations', 'image_id' (coco)",
                 " and 'detections' (oa-slam)"},
                "other.json");
}

TEST_F(OpenMasksTest, EveryFormatHasItsOwnName) {
  const std::vector<std::string> names = MaskFormatNames();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  EXPECT_EQ(std::count(names.begin(), names.end(), ""), 0);
}

TEST_F(OpenMasksTest, NoFormatTakesAFileOrAFolderWithoutMasks) {
  folder_.Write("masks/file", "[]");
  for (const std::string& name : MaskFormatNames()) {
    format_ = name;
    ExpectRefusal({Path("file").string()}, "file");
    ExpectRefusal({Path().string()});
  }
}

TEST_F(OpenMasksTest, UnknownFormatIsRefused) {
  Write("1.5.txt", kYoloSeg);
  format_ = "yolo";
  ExpectRefusal({"--masks-format is 'yolo'", "yolo-seg"});
}

TEST_F(OpenMasksTest, MasksOfOtherFramesAreRefusedWithAnExample) {
  Write("0001.txt", kYoloSeg);
  Write("0002.txt", kYoloSeg);
  ExpectRefusal({Path().string(), "any of the 2 frames", "'0001.txt'", "'1.5'"});
}

TEST_F(OpenMasksTest, TheCauseOfACommonMistakeIsNamed) {
  Write("labels/1.5.txt", "41 0.5 0.5 0.1 0.1\n");
  ExpectRefusal({"did you mean " + Path("labels").string() + "?"});
  Write("1.5.txt", "41 160 120 320 120 160 360\n");
  ExpectRefusal({"if these are pixels, divide x by the width"});
}

}  // namespace
}  // namespace hullslam

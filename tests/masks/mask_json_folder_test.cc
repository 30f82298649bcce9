// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "masks/mask_fixture.h"
#include "masks/mask_format.h"

namespace hullslam {
namespace {

class JsonFolderTest : public MaskFixture {
 protected:
  JsonFolderTest() : MaskFixture("") { Write("2.5.json", "[]"); }

  FrameMasks ReadJson(const std::string& json) const {
    Write("1.5.json", json);
    EXPECT_EQ(Open()->format(), "json");
    return ReadFrame(0);
  }
  void ExpectRefused(const std::string& json, const std::vector<std::string>& parts) const {
    Write("1.5.json", json);
    std::vector<std::string> all = {Path("1.5.json").string() + ": "};
    all.insert(all.end(), parts.begin(), parts.end());
    ExpectRefusal(all);
  }
};

// 480 rows: 30 columns outside, 2 columns inside.
const char* const kRuns = R"({"size": [480, 640], "counts": [14400, 960, 291840]})";

TEST_F(JsonFolderTest, MasksOfSegmentAnythingHaveNoClass) {
  const FrameMasks frame = ReadJson(
      std::string(R"([{"area": 960, "predicted_iou": 0.9, "segmentation": )") + kRuns + "}]");
  ASSERT_EQ(frame.masks.size(), 1U);
  EXPECT_EQ(frame.masks[0].label, "object");
  EXPECT_NEAR(Area(frame.masks[0].outlines.at(0)), 960.0, 1.0);
  EXPECT_FALSE(ReadFrame(1).is_missing);
}

TEST_F(JsonFolderTest, AnnotationsMayComeBeforeTheirCategories) {
  const FrameMasks frame = ReadJson(
      std::string(R"({"image": {"file_name": "a.jpg"}, "annotations": [{"category_id": 3, )") +
      R"("segmentation": )" + kRuns + R"(}, {"iscrowd": 1}, {"segmentation": null}],)" +
      R"("categories": [{"id": 3, "name": "mug"}]})");
  ASSERT_EQ(frame.masks.size(), 1U);
  EXPECT_EQ(frame.masks[0].label, "mug");
  EXPECT_EQ(frame.crowds, 1U);
  EXPECT_EQ(frame.without_area, 1U);
}

TEST_F(JsonFolderTest, ShapesOfLabelMeAreOutlinesAndBoxes) {
  const FrameMasks frame = ReadJson(R"({"version": "5", "flags": {}, "shapes": [
    {"label": "cup", "points": [[10.5, 20.5], [50.5, 20.5], [10.5, 60.5]], "shape_type": "polygon"},
    {"label": "tv", "score": 0.5, "points": [[30, 40], [10, 20]], "shape_type": "rectangle"},
    {"label": "tip", "points": [[5, 5]], "shape_type": "point"}],
    "imagePath": "1.5.jpg", "imageData": null, "imageHeight": 480, "imageWidth": 640})");
  ASSERT_EQ(frame.masks.size(), 2U);
  EXPECT_EQ(frame.masks[0].label, "cup");
  EXPECT_EQ(frame.masks[0].outlines[0],
            (std::vector<Eigen::Vector2d>{{10.0, 20.0}, {50.0, 20.0}, {10.0, 60.0}}));
  EXPECT_EQ(frame.masks[1].score, 0.5);
  EXPECT_EQ(frame.masks[1].shape, MaskShape::kBox);
  EXPECT_EQ(Area(frame.masks[1].outlines[0]), 400.0);
  EXPECT_EQ(frame.without_area, 1U);
}

const char* const kPolygon =
    R"({"shapes": [{"label": "cup", "points": [[1, 1], [9, 1], [1, 9]]}]})";

// LabelMe keeps lists of labels, notes and the images themselves in the same folder.
TEST_F(JsonFolderTest, OtherFilesBesideTheFilesOfFramesDoNotCount) {
  Write("labels.txt", "cup\ntv\n");
  Write("poses.txt", "0 0.5 0.5 0.5 0.5 0.5 0.5\n");
  Write("config.json", R"({"a": 1})");
  Write("1.5.png", "");
  EXPECT_EQ(ReadJson(kPolygon).masks.size(), 1U);
}

TEST_F(JsonFolderTest, TheFileOfASingleFrameIsEnough) {
  std::filesystem::remove(Path("2.5.json"));
  Write("readme.txt", "the first image only");
  EXPECT_EQ(ReadJson(kPolygon).masks.size(), 1U);
  EXPECT_TRUE(ReadFrame(1).is_missing);
}

TEST_F(JsonFolderTest, TextFilesOfFramesAreTheirMasks) {
  Write("1.5.txt", "0 0.1 0.1 0.2 0.1 0.2 0.2\n");
  std::filesystem::remove(Path("2.5.json"));
  Write("notes.json", R"({"a": 1})");
  EXPECT_EQ(Open()->format(), "yolo-seg");
}

TEST_F(JsonFolderTest, TheInstancesOfAFileAreCounted) {
  const FrameMasks frame = ReadJson(R"({"shapes": [
    {"label": "cup", "group_id": 3, "points": [[1, 1], [9, 1], [1, 9]]},
    {"label": "tip", "points": [[5, 5]], "shape_type": "point"},
    {"label": "cup", "group_id": 3, "points": [[21, 1], [29, 1], [21, 9]]},
    {"label": "tv", "points": [[41, 1], [49, 1], [41, 9]]}]})");
  ASSERT_EQ(frame.masks.size(), 2U);
  EXPECT_EQ(frame.masks[0].outlines.size(), 2U);
  EXPECT_EQ(frame.without_area, 1U);
  EXPECT_EQ(frame.rows, (std::vector<size_t>{0, 2}));
}

TEST_F(JsonFolderTest, BrokenFilesAreRefused) {
  ExpectRefused("[{", {"no valid JSON"});
  ExpectRefused("[{}]", {"[0]: has neither 'segmentation' nor 'bbox'"});
  ExpectRefused(R"([{"segmentation": [[1, 2, 700, 4, 5, 6]]}])", {"[0]: ", "(700, 4)"});
  ExpectRefused(R"({"shapes": [{"points": []}]})", {"shapes[0]: has no 'label'"});
  ExpectRefused(R"({"shapes": [{"label": "cup"}]})", {"shapes[0]: has no 'points'"});
  ExpectRefused(R"({"shapes": [{"label": "cup", "points": [[1]]}]})", {"a point is [1]"});
  ExpectRefused(R"({"shapes": [{"label": "cup", "points": [[1, 1], [700, 1], [1, 9]]}]})",
                {"shapes[0]: point (700, 1) is outside"});
  std::string many = R"({"shapes": [)";
  for (int i = 0; i < 1'001; ++i) {
    many += R"({"label": "cup", "points": []},)";
  }
  ExpectRefused(many + "{}]}", {"too many instances"});
}

}  // namespace
}  // namespace hullslam

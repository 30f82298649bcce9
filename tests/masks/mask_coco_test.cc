// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "masks/mask_fixture.h"
#include "masks/mask_format.h"

namespace hullslam {
namespace {

class CocoTest : public MaskFixture {
 protected:
  CocoTest() : MaskFixture("coco") {}

  FrameMasks ReadJson(size_t frame, const std::string& json) const {
    Write("masks.json", json);
    return ReadFrame(frame, "masks.json");
  }
  void ExpectRefusedJson(const std::string& json, const std::vector<std::string>& parts) const {
    Write("masks.json", json);
    std::vector<std::string> all = {Path("masks.json").string() + ": "};
    all.insert(all.end(), parts.begin(), parts.end());
    ExpectRefusal(all, "masks.json");
  }
  // Expects that a file is refused whose only annotation, of the first frame, has these members in
  // addition.
  void ExpectRefusedMember(const std::string& members,
                           const std::vector<std::string>& parts) const {
    ExpectRefusedJson("[{\"image_id\": \"1.5\", " + members + "}]", parts);
  }
};

const char* const kInstances = R"({
  "info": {"year": 2024},
  "annotations": [
    {"id": 1, "image_id": 31, "category_id": 5, "iscrowd": 0, "bbox": [1, 1, 2, 2],
     "segmentation": [[10.5, 20.5, 50.5, 20.5, 10.5, 60.5], [100, 100, 300, 100, 100, 300]]},
    {"id": 2, "image_id": 31, "category_id": 9, "iscrowd": 1, "segmentation": {"size": [1, 1]}},
    {"id": 3, "image_id": 32, "category_id": 9, "bbox": [0.0, 0.0, 30.0, 40.0], "score": 0.5}],
  "images": [
    {"id": 31, "file_name": "rgb/1.5.png", "width": 640, "height": 480},
    {"id": 32, "file_name": "2.5.jpg"}, {"id": 33, "file_name": "3.5.jpg"}],
  "categories": [{"id": 5, "name": "robot"}, {"id": 9, "name": "ball"}]})";

// Run lengths of a mask that consists of the columns 2 and 3.
const char* const kCounts = R"({"size": [480, 640], "counts": [960, 480, 0, 480, 305280]})";

TEST_F(CocoTest, ImagesAndCategoriesMayComeInAnyOrder) {
  const FrameMasks frame = ReadJson(0, kInstances);
  ASSERT_EQ(frame.masks.size(), 1U);
  EXPECT_EQ(frame.crowds, 1U);
  EXPECT_EQ(frame.masks[0].label, "robot");
  EXPECT_EQ(frame.masks[0].score, 1.0);
  EXPECT_EQ(frame.masks[0].shape, MaskShape::kContour);
  ASSERT_EQ(frame.masks[0].outlines.size(), 2U);
  // The larger part comes first. In the file, the corners of pixels have integer coordinates.
  EXPECT_EQ(frame.masks[0].outlines[0][0], Eigen::Vector2d(99.5, 99.5));
  EXPECT_EQ(frame.masks[0].outlines[1][0], Eigen::Vector2d(10.0, 20.0));
}

TEST_F(CocoTest, WithoutSegmentationTheBoxIsUsed) {
  const FrameMasks frame = ReadJson(1, kInstances);
  ASSERT_EQ(frame.masks.size(), 1U);
  EXPECT_EQ(frame.masks[0].label, "ball");
  EXPECT_EQ(frame.masks[0].score, 0.5);
  EXPECT_EQ(frame.masks[0].shape, MaskShape::kBox);
  EXPECT_EQ(frame.masks[0].outlines[0][2], Eigen::Vector2d(29.5, 39.5));
}

TEST_F(CocoTest, ImagesWithoutAnnotationsAreNotMissing) {
  Write("masks.json", kInstances);
  const auto source = Open("masks.json");
  EXPECT_TRUE(source->Contains({"3.5", 2}));
  EXPECT_TRUE(source->Read({"3.5", 2}).masks.empty());
  EXPECT_FALSE(source->Contains({"4.5", 3}));
  EXPECT_TRUE(source->Read({"4.5", 3}).is_missing);
}

TEST_F(CocoTest, ResultsUseStemsAsIdsAndTheCategoriesOfCoco) {
  const FrameMasks frame = ReadJson(0, std::string(R"([
    {"image_id": "1.5", "category_id": 47, "score": 0.9, "segmentation": )") +
                                           kCounts + R"(},
    {"image_id": "1.5.png", "score": 0.8, "bbox": [10, 20, 30, 40], "segmentation": []}])");
  ASSERT_EQ(frame.masks.size(), 2U);
  EXPECT_EQ(frame.masks[0].label, "cup");
  EXPECT_EQ(frame.masks[0].score, 0.9);
  ASSERT_EQ(frame.masks[0].outlines.size(), 1U);
  EXPECT_DOUBLE_EQ(Area(frame.masks[0].outlines[0]), 960.0 - 0.5);  // columns 2 and 3
  for (const Eigen::Vector2d& point : frame.masks[0].outlines[0]) {
    EXPECT_TRUE(point.x() >= 1.5 && point.x() <= 3.5) << point;
  }
  EXPECT_EQ(frame.masks[1].label, "object");  // no category: SAM has none
}

TEST_F(CocoTest, CompressedAndPlainRunsGiveTheSameMask) {
  const auto read = [&](const std::string& counts) {
    return ReadJson(0, R"([{"image_id": "1.5", "segmentation": {"size": [480, 640], "counts": )" +
                           counts + "}}]")
        .masks.at(0)
        .outlines;
  };
  // In groups of five bits: 100 = 3 x 32 + 4, 200 = 6 x 32 + 8, 306900 = 9 x 32768 + 11 x 1024 + 22
  // x 32 + 20.
  EXPECT_EQ(read("[100, 200, 306900]"), read("\"T3X6df[9\""));
}

TEST_F(CocoTest, ImageNumbersMatchStemsOfDigits) {
  frames_ = {{"000012", 0}, {"000000", 1}};
  const std::string json = R"([{"image_id": 12, "bbox": [1, 1, 20, 20]},
                               {"image_id": 0, "bbox": [1, 1, 20, 20]}])";
  EXPECT_EQ(ReadJson(0, json).masks.size(), 1U);
  EXPECT_EQ(ReadJson(1, json).masks.size(), 1U);
}

TEST_F(CocoTest, IsDetected) {
  format_ = "";
  Write("masks.json", kInstances);
  EXPECT_EQ(Open("masks.json")->format(), "coco");
  Write("masks.json", R"([{"image_id": "1.5", "bbox": [1, 1, 20, 20]}])");
  EXPECT_EQ(Open("masks.json")->format(), "coco");
}

TEST_F(CocoTest, BrokenRunsAreRefused) {
  const auto refuse = [&](const std::string& segmentation, const std::vector<std::string>& parts) {
    ExpectRefusedMember("\"segmentation\": " + segmentation, parts);
  };
  refuse(R"({"size": [480, 640], "counts": [960, 480]})",
         {"[0]: counts of segmentation add up to 1440", "307200"});
  refuse(R"({"size": [480, 640], "counts": "d05"})", {"add up to 25", "307200"});
  refuse(R"({"size": [480, 640], "counts": [4294967295, 4294967295]})", {"add up to 8589934590"});
  refuse(R"({"size": [480, 640], "counts": [307201, -1]})", {"expected a list of integers >= 0"});
  refuse(R"({"size": [480, 640], "counts": "d"})", {"COCO's compressed form"});
  refuse(R"({"size": [480, 640], "counts": 7})", {"counts of segmentation are 7"});
  refuse(R"({"size": [480, 640]})", {"has no 'counts'"});
  refuse(R"({"counts": [307200]})", {"has no 'size'"});
  refuse(R"({"size": [640, 480], "counts": [307200]})", {"size of segmentation is [640,480]"});
}

TEST_F(CocoTest, BrokenAnnotationsAreRefused) {
  ExpectRefusedMember(R"("segmentation": [[1, 2, 3, 4, 5, 6, 7]])", {"has 7 numbers"});
  ExpectRefusedMember(R"("segmentation": [[1, 2, 3, 4, 5, "6"]])", {"a list of numbers"});
  ExpectRefusedMember(R"("segmentation": [1, 2, 3, 4, 5, 6])", {"a list of numbers"});
  ExpectRefusedMember(R"("segmentation": "all")", {"segmentation is \"all\""});
  ExpectRefusedMember(R"("segmentation": [[1, 2, 700, 4, 5, 6]])", {"(700, 4)", "640x480 px"});
  ExpectRefusedMember(R"("bbox": [1, 2, -3, 4])", {"bbox is [1,2,-3,4]"});
  ExpectRefusedMember(R"("bbox": [1, 2, 3])", {"bbox is [1,2,3]"});
  ExpectRefusedMember(R"("bbox": [1e300, 2, 3, 4])", {"bbox is [1e+300,", "up to 1e+06 px"});
  ExpectRefusedMember(R"("id": 7)", {"has neither 'segmentation' nor 'bbox'"});
  ExpectRefusedMember(R"("bbox": [1, 2, 3, 4], "score": 1.5)", {"score is 1.5", "from 0 to 1"});
  ExpectRefusedMember(R"("bbox": [1, 2, 3, 4], "score": "high")", {"score is \"high\""});
  ExpectRefusedMember(R"("bbox": [1, 2, 3, 4], "category_id": 12)", {"category_id is 12"});
  ExpectRefusedMember(R"("bbox": [1, 2, 3, 4], "category_id": "cup")", {"category_id is \"cup\""});
  ExpectRefusedMember(R"("bbox": [1, 2, 3, 4], "category_id": 18446744073709551615)",
                      {"category_id is 18446744073709551615", "an integer"});
  ExpectRefusedJson(R"([{"bbox": [1, 2, 3, 4]}])", {"has no 'image_id'"});
  ExpectRefusedJson(R"([{"image_id": 1.5, "bbox": [1, 2, 3, 4]}])", {"image_id is 1.5"});
}

TEST_F(CocoTest, InstancesWithoutAnOutlineAreLeftOutAndCounted) {
  const FrameMasks frame = ReadJson(0, R"([
    {"image_id": "1.5", "segmentation": null},
    {"image_id": "1.5", "segmentation": [[10, 10, 20, 20]], "bbox": [1, 2, 30, 40]},
    {"image_id": "1.5", "segmentation": [], "bbox": [0, 0, 0, 0]},
    {"image_id": "1.5", "segmentation": [[10, 10, 20, 20], [100, 100, 300, 100, 100, 300]]},
    {"image_id": "1.5", "segmentation": null, "bbox": [1, 2, 30, 40]}])");
  EXPECT_EQ(frame.without_area, 3U);
  ASSERT_EQ(frame.masks.size(), 2U);
  EXPECT_EQ(frame.masks[0].outlines.size(), 1U);
  EXPECT_EQ(frame.masks[1].shape, MaskShape::kBox);
}

// Tools name the same values in other ways, or write numbers as text.
TEST_F(CocoTest, ValuesUnderOtherNamesAreRead) {
  const FrameMasks frame = ReadJson(0, R"([
    {"image_id": "1.5", "confidence": 0.5, "label": "mug", "bbox": [1, 2, 30, 40]},
    {"image_id": "1.5", "score": "0.25", "category_id": "47", "bbox": [1, 2, 30, 40]},
    {"image_id": "1.5", "score": null, "bbox": [1, 2, 30, 40]}])");
  ASSERT_EQ(frame.masks.size(), 3U);
  EXPECT_EQ(frame.masks[0].score, 0.5);
  EXPECT_EQ(frame.masks[0].label, "mug");
  EXPECT_EQ(frame.masks[1].score, 0.25);
  EXPECT_EQ(frame.masks[1].label, "cup");
  EXPECT_EQ(frame.masks[2].score, 1.0);
  ExpectRefusedMember(R"("score": "high", "bbox": [1, 2, 3, 4])", {"score is \"high\""});
  ExpectRefusedMember(R"("confidence": 95, "bbox": [1, 2, 3, 4])", {"confidence is 95"});
}

TEST_F(CocoTest, BrokenTablesAreRefused) {
  const auto refuse = [&](const std::string& from, const std::string& to,
                          const std::vector<std::string>& parts) {
    std::string json = kInstances;
    ExpectRefusedJson(json.replace(json.find(from), from.size(), to), parts);
  };
  refuse("\"id\": 31", "\"id\": 30", {"annotations[0]: image_id 31", "'images'"});
  refuse("{\"id\": 5", "{\"id\": 6", {"annotations[0]: category_id 5", "'categories'"});
  refuse("640", "320", {"images[0]: width is 320", "640"});
  refuse("\"file_name\": \"2.5.jpg\"", "\"name\": \"2.5.jpg\"", {"images[1]: has no 'file_name'"});
  refuse("\"file_name\": \"2.5.jpg\"", "\"file_name\": 2", {"images[1]: file_name is 2"});
  refuse("{\"id\": 9, \"name\"", "{\"name\"", {"categories[1]: has no 'id'"});
}

TEST_F(CocoTest, FilesThatAreNotJsonAreRefused) {
  ExpectRefusedJson("", {"no valid JSON"});
  ExpectRefusedJson("annotations", {"no valid JSON", "line 1, column 1"});
  ExpectRefusedJson(std::string(kInstances).substr(0, 400), {"no valid JSON", "line "});
  ExpectRefusedJson(R"([{"image_id": "1.5", "bbox": [NaN, 2, 3, 4]}])", {"no valid JSON"});
  ExpectRefusedJson(R"([{"image_id": "1.5", "bbox": [1e999, 2, 3, 4]}])", {"no valid JSON"});
  ExpectRefusedJson("[]", {"there is nothing", "'1.5'"});
  ExpectRefusedJson("7", {"there is nothing"});
}

TEST_F(CocoTest, HugeFilesAreRefused) {
  std::string many = "[";
  for (int i = 0; i < 1'001; ++i) {
    many += R"({"image_id": "1.5", "bbox": [1, 2, 3, 4]},)";
  }
  many.back() = ']';
  ExpectRefusedJson(many, {"[1000]: too many instances", "1000"});
  many = R"([{"image_id": "1.5", "segmentation": [[)";
  for (int i = 0; i < 2'000'000; ++i) {
    many += "1,";
  }
  many.back() = ']';
  ExpectRefusedJson(many + "]}]", {"more than 2000000 values"});
  many = R"([{"image_id": "1.5", "segmentation": [[)";
  for (int i = 0; i < 200'002; ++i) {
    many += "1,";
  }
  many.back() = ']';
  ExpectRefusedJson(many + "]}]", {"[0]: ", "100001 points", "at most 100000"});
}

// A run of one pixel is one character in the file, but four bytes in memory.
TEST_F(CocoTest, MasksThatTakeTooMuchMemoryAreRefused) {
  const std::string runs = "\"111" + std::string(307'197, '0') + "\"";
  std::string many = "[";
  for (int i = 0; i < 420; ++i) {
    many += R"({"image_id": "1.5", "segmentation": {"size": [480, 640], "counts": )" + runs + "}},";
  }
  many.back() = ']';
  ExpectRefusedJson(many, {"[416]: the masks up to here take more than 512 MB"});
}

}  // namespace
}  // namespace hullslam

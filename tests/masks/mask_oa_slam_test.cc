// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "masks/mask_fixture.h"
#include "masks/mask_format.h"

namespace hullslam {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

class OaSlamTest : public MaskFixture {
 protected:
  OaSlamTest() : MaskFixture("oa-slam") {}

  FrameMasks ReadJson(const std::string& json) const {
    Write("detections.json", json);
    return ReadFrame(0, "detections.json");
  }
  FrameMasks ReadDetections(const std::string& detections) const {
    return ReadJson("[{\"file_name\": \"/data/rgb/1.5.png\", \"detections\": [" + detections +
                    "]}]");
  }
  void ExpectRefusedJson(const std::string& json, const std::vector<std::string>& parts) const {
    Write("detections.json", json);
    std::vector<std::string> all = {Path("detections.json").string() + ": "};
    all.insert(all.end(), parts.begin(), parts.end());
    ExpectRefusal(all, "detections.json");
  }
  void ExpectRefusedDetection(const std::string& detection,
                              const std::vector<std::string>& parts) const {
    ExpectRefusedJson("[{\"file_name\": \"1.5.png\", \"detections\": [" + detection + "]}]", parts);
  }
};

const char* const kCup =
    R"({"category_id": 41, "detection_score": 0.9, "bbox": [100.0, 50.0, 140.0, 80.0]})";

TEST_F(OaSlamTest, BoxesAreGivenByTheirCorners) {
  const FrameMasks frame = ReadDetections(kCup);
  ASSERT_EQ(frame.masks.size(), 1U);
  EXPECT_EQ(frame.masks[0].label, "cup");
  EXPECT_EQ(frame.masks[0].score, 0.9);
  EXPECT_EQ(frame.masks[0].shape, MaskShape::kBox);
  EXPECT_EQ(frame.masks[0].outlines[0][0], Eigen::Vector2d(99.5, 49.5));
  EXPECT_EQ(frame.masks[0].outlines[0][2], Eigen::Vector2d(139.5, 79.5));
  EXPECT_TRUE(Open("detections.json")->Read(frames_[1]).is_missing);
}

// Without this, a detection whose confidence is "score" would count as certain.
TEST_F(OaSlamTest, TheConfidenceMayHaveTheNamesOfOtherTools) {
  for (const char* const name : {"score", "confidence"}) {
    const FrameMasks frame = ReadDetections(
        fmt::format(R"({{"category_id": 41, "{}": 0.5, "bbox": [100, 50, 140, 80]}})", name));
    EXPECT_EQ(frame.masks.at(0).score, 0.5) << name;
  }
}

// Axes may be half or full axes, and angles may be in radians or degrees. The box tells which.
TEST_F(OaSlamTest, EllipsesAreReadInAllUnits) {
  const double turn = 30.0 * kDegree;
  const double half_width = std::hypot(40.0 * std::cos(turn), 20.0 * std::sin(turn));
  const double half_height = std::hypot(40.0 * std::sin(turn), 20.0 * std::cos(turn));
  for (const double axis : {1.0, 2.0}) {
    for (const double angle : {turn, 30.0}) {
      const FrameMasks frame = ReadDetections(fmt::format(
          R"({{"category_id": "cup", "bbox": [{}, {}, {}, {}], "ellipse": [200, 100, {}, {}, {}]}})",
          200.0 - half_width, 100.0 - half_height, 200.0 + half_width, 100.0 + half_height,
          40.0 * axis, 20.0 * axis, angle));
      const InstanceMask& cup = frame.masks.at(0);
      EXPECT_EQ(cup.shape, MaskShape::kEllipse);
      ASSERT_EQ(cup.outlines[0].size(), 64U);
      for (const Eigen::Vector2d& point : cup.outlines[0]) {
        const Eigen::Vector2d d = point - Eigen::Vector2d(200.0, 100.0);
        const double u = std::cos(turn) * d.x() + std::sin(turn) * d.y();
        const double v = std::cos(turn) * d.y() - std::sin(turn) * d.x();
        EXPECT_NEAR(std::hypot(u / 40.0, v / 20.0), 1.0, 1e-9);
      }
    }
  }
}

TEST_F(OaSlamTest, AClassesFileNextToTheFileNamesTheClasses) {
  Write("classes.txt", "robot\nball\n");
  EXPECT_EQ(ReadDetections(R"({"category_id": 1, "bbox": [1, 1, 9, 9]})").masks.at(0).label,
            "ball");
}

TEST_F(OaSlamTest, IsDetected) {
  format_ = "";
  ReadDetections(kCup);
  EXPECT_EQ(Open("detections.json")->format(), "oa-slam");
}

TEST_F(OaSlamTest, BrokenDetectionsAreRefused) {
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = kCup;
    return text.replace(text.find(from), from.size(), to);
  };
  ExpectRefusedDetection(replaced("41", "80"), {"[0]: category_id is 80", "from 0 to 79"});
  ExpectRefusedDetection(replaced("41", "-1"), {"category_id is -1"});
  ExpectRefusedDetection(replaced("41", "\"\""), {"category_id is \"\""});
  ExpectRefusedDetection(replaced("category_id", "category"), {"has no 'category_id'"});
  ExpectRefusedDetection(replaced("0.9", "90"), {"detection_score is 90"});
  ExpectRefusedDetection(replaced("100.0", "150"), {"bbox is [150,", "x1 <= x2"});
  ExpectRefusedDetection(replaced("100.0,", ""), {"bbox is [50.0,", "x1, y1, x2, y2"});
  ExpectRefusedDetection(replaced("100.0", "null"), {"bbox is [null,", "a list of numbers"});
  ExpectRefusedDetection(replaced("bbox", "box"), {"has no 'bbox'"});
  const auto ellipse = [&](const std::string& numbers) {
    return replaced("}", ", \"ellipse\": " + numbers + "}");
  };
  ExpectRefusedDetection(ellipse("[1, 2, 3, 4]"), {"ellipse is [1,2,3,4]", "cx, cy, a, b, angle"});
  ExpectRefusedDetection(ellipse("[1, 2, 0, 4, 5]"), {"expected axes > 0"});
  for (const char* const huge : {"1e4", "1e7", "1e12", "1e150", "1e308"}) {
    const std::vector<std::string> parts = {"ellipse is [", "up to 3200 px", "640x480"};
    ExpectRefusedDetection(ellipse(fmt::format("[1, 2, {}, 4, 5]", huge)), parts);
    ExpectRefusedDetection(ellipse(fmt::format("[1, 2, 3, {}, 5]", huge)), parts);
    ExpectRefusedDetection(ellipse(fmt::format("[{}, 2, 3, 4, 5]", huge)), parts);
    ExpectRefusedDetection(ellipse(fmt::format("[1, -{}, 3, 4, 5]", huge)), parts);
    ExpectRefusedDetection(ellipse(fmt::format("[1, 2, 3, 4, {}]", huge)), {"an angle up to 360"});
  }
  ExpectRefusedDetection(replaced("140.0", "1e200"), {"bbox is [100.0,", "up to 1e+06 px"});
  ExpectRefusedDetection("7", {"has no 'category_id'"});
}

TEST_F(OaSlamTest, BrokenFilesAreRefused) {
  ExpectRefusedJson("detections", {"no valid JSON", "line 1, column 1"});
  ExpectRefusedJson(R"([{"detections": []}])", {"[0]: has no 'file_name'"});
  ExpectRefusedJson(R"([{"file_name": "1.5.png"}])", {"has no 'detections'"});
  ExpectRefusedJson(R"([{"file_name": "1.5.png", "detections": 3}])", {"a list"});
  ExpectRefusedJson(R"([{"file_name": "9.5.png", "detections": []}])", {"'9.5'", "'1.5'"});
  std::string many = kCup;
  for (int i = 0; i < 1'000; ++i) {
    many += std::string(",") + kCup;
  }
  ExpectRefusedDetection(many, {"too many instances"});
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/labelme_shapes.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/core.hpp>
#include <string>

#include "files/base64.h"
#include "frame/detection/mask_outline.h"
#include "geometry/polygon.h"
#include "images/image_file.h"
#include "support/expect_error.h"

namespace hullslam {
namespace {

using Json = nlohmann::json;

const std::filesystem::path kFile = "a.json";
const MaskRequest kRequest = {.path = {}, .format = {}, .width = 640, .height = 480};

std::vector<InstanceMask> Read(const std::vector<Json>& shapes) {
  LabelMeShapes read(kRequest);
  for (size_t i = 0; i < shapes.size(); ++i) {
    read.Add({kFile, "shapes", i, shapes[i]});
  }
  return read.Take();
}

Json Shape(const char* type, const Json& points) {
  return {{"label", "cup"}, {"shape_type", type}, {"points", points}, {"group_id", nullptr}};
}

void ExpectRefused(const Json& shape, const std::vector<std::string>& parts) {
  ExpectInputError([&] { Read({shape}); }, parts);
}

// The pixels of a ring from (100, 50) on.
cv::Mat Ring() {
  cv::Mat ring(40, 60, CV_8UC1, cv::Scalar(0));
  ring(cv::Rect(0, 0, 60, 40)).setTo(1);
  ring(cv::Rect(20, 10, 15, 12)).setTo(0);
  ring(cv::Rect(0, 0, 5, 40)).setTo(0);
  ring(cv::Rect(0, 30, 3, 3)).setTo(1);  // a part of its own
  return ring;
}

Json MaskOf(const cv::Mat& pixels, int x, int y) {
  Json shape = Shape("mask", {{x, y}, {x + pixels.cols - 1, y + pixels.rows - 1}});
  shape["mask"] = EncodeBase64(EncodeImage(pixels, ".png"));
  return shape;
}

TEST(LabelMeShapes, AMaskHasTheOutlinesOfItsPixels) {
  cv::Mat whole(480, 640, CV_8UC1, cv::Scalar(0));
  Ring().copyTo(whole(cv::Rect(100, 50, 60, 40)));
  const std::vector<InstanceMask> masks = Read({MaskOf(Ring(), 100, 50)});
  ASSERT_EQ(masks.size(), 1u);
  EXPECT_EQ(masks[0].shape, MaskShape::kContour);
  EXPECT_EQ(masks[0].outlines, FindMaskOutlines(whole));
  EXPECT_EQ(masks[0].outlines.size(), 2u);
}

TEST(LabelMeShapes, MasksThatDoNotFitAreRefused) {
  Json shape = MaskOf(Ring(), 100, 50);
  shape["points"][1][0] = 170;
  ExpectRefused(shape, {"a.json: shapes[0]: mask has 60x40 px", "(100, 50) to (170, 89)"});
  ExpectRefused(MaskOf(Ring(), 600, 50), {"shapes[0]: mask has 60x40 px", "640x480"});
  ExpectRefused(MaskOf(Ring(), -1, 50), {"shapes[0]: mask has 60x40 px"});
  shape["mask"] = "***";
  ExpectRefused(shape, {"mask is \"***\", expected a PNG in base64"});
  shape["mask"] = 3;
  ExpectRefused(shape, {"mask is 3, expected a PNG in base64"});
  shape["mask"] = EncodeBase64("no image");
  ExpectRefused(shape, {"a.json: shapes[0].mask: is neither a PNG"});
  shape.erase("mask");
  ExpectRefused(shape, {"shapes[0]: has no 'mask'"});
}

TEST(LabelMeShapes, ACircleGoesThroughItsSecondPoint) {
  const std::vector<InstanceMask> masks = Read({Shape("circle", {{200.5, 100.5}, {230.5, 140.5}})});
  const std::vector<Eigen::Vector2d>& outline = masks.at(0).outlines.at(0);
  for (const Eigen::Vector2d& point : outline) {
    EXPECT_NEAR((point - Eigen::Vector2d(200.0, 100.0)).norm(), 50.0, 1e-9);
  }
  EXPECT_NEAR(std::abs(SignedArea(outline)) / (std::numbers::pi * 2500.0), 1.0, 0.005);
}

// Only the points of the outline that are in the image are on the border.
TEST(LabelMeShapes, CirclesAndTurnedBoxesEndAtTheBorderOfTheImage) {
  const auto outline = [](const Json& shape) { return Read({shape}).at(0).outlines.at(0); };
  // The centre is outside, so less than half of the circle is inside.
  const auto circle = outline(Shape("circle", {{-30.0, 100.0}, {20.0, 100.0}}));
  for (const Eigen::Vector2d& point : circle) {
    EXPECT_GE(point.x(), -0.5 - 1e-9);
    EXPECT_LE(std::abs(point.y() + 0.5 - 100.0), 40.0 + 0.1) << "where it crosses the border";
  }
  // A square that stands on its corner, half of it outside.
  const auto box = outline(Shape("rotation", {{0, 90}, {10, 100}, {0, 110}, {-10, 100}}));
  EXPECT_NEAR(std::abs(SignedArea(box)), 100.0, 1e-9);
  const auto other_way = outline(Shape("rotation", {{0, 90}, {-10, 100}, {0, 110}, {10, 100}}));
  EXPECT_NEAR(std::abs(SignedArea(other_way)), 100.0, 1e-9);
  EXPECT_TRUE(outline(Shape("circle", {{-90.0, 100.0}, {-80.0, 100.0}})).empty());
}

TEST(LabelMeShapes, ATurnedBoxIsAnOutline) {
  for (const char* const type : {"rotation", "oriented_rectangle"}) {
    const InstanceMask mask = Read({Shape(type, {{50, 20}, {80, 60}, {40, 90}, {10, 50}})}).at(0);
    EXPECT_EQ(mask.shape, MaskShape::kContour);
    EXPECT_NEAR(std::abs(SignedArea(mask.outlines.at(0))), 2500.0, 1e-9) << type;
  }
}

TEST(LabelMeShapes, ShapesWithoutAnAreaHaveNoOutline) {
  for (const char* const type : {"point", "line", "linestrip", "points", "circle", "unknown"}) {
    EXPECT_TRUE(Read({Shape(type, {{5, 5}})}).at(0).outlines.empty()) << type;
  }
}

TEST(LabelMeShapes, AGroupIsOneInstance) {
  const auto part = [](int x, const Json& group, const char* label = "cup") {
    Json shape = Shape("polygon", {{x, 10}, {x + 20, 10}, {x, 40}});
    shape["group_id"] = group;
    shape["label"] = label;
    return shape;
  };
  Json box = Shape("rectangle", {{300, 10}, {320, 40}});
  box["group_id"] = 7;
  box["score"] = 0.5;
  const std::vector<InstanceMask> masks =
      Read({part(10, 7), part(50, nullptr), part(90, 7), part(130, 7, "tv"), part(170, 8),
            part(210, nullptr), box});
  ASSERT_EQ(masks.size(), 5u);
  EXPECT_EQ(masks[0].label, "cup");
  EXPECT_EQ(masks[0].outlines.size(), 3u);
  EXPECT_EQ(masks[0].shape, MaskShape::kContour);
  EXPECT_EQ(masks[0].score, 1.0);
  EXPECT_EQ(masks[0].outlines[1][0].x(), 89.5);
  EXPECT_EQ(masks[1].outlines.size(), 1u);
  EXPECT_EQ(masks[2].label, "tv");
  EXPECT_EQ(masks[3].outlines.at(0).at(0).x(), 169.5);
  EXPECT_EQ(masks[4].outlines.at(0).at(0).x(), 209.5);
}

TEST(LabelMeShapes, BrokenShapesAreRefused) {
  ExpectRefused({{"points", Json::array()}}, {"a.json: shapes[0]: has no 'label'"});
  ExpectRefused({{"label", "cup"}}, {"shapes[0]: has no 'points'"});
  ExpectRefused(Shape("circle", {{1, 1}, {1e300, 1}}), {"a point is", "up to 1e+06 px"});
  ExpectRefused(Shape("polygon", {{1, 1}, {700, 1}, {1, 9}}), {"point (700, 1) is outside"});
}

}  // namespace
}  // namespace hullslam

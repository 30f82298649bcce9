// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/frame_detector.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hullslam {
namespace {

constexpr PinholeCamera kCameraOfPair{
    .fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0, .bf = 50.0};

// A box of 40 x 60 px with a line at each side.
Detection BoxAt(const std::string& label, double x, double y) {
  Detection detection;
  detection.label = label;
  detection.hull = {{x, y}, {x + 40.0, y}, {x + 40.0, y + 60.0}, {x, y + 60.0}};
  detection.box = Eigen::AlignedBox2d(Eigen::Vector2d(x, y), Eigen::Vector2d(x + 40.0, y + 60.0));
  detection.lines = {{{{-1.0, 0.0}, x}, false},
                     {{{1.0, 0.0}, -x - 40.0}, false},
                     {{{0.0, -1.0}, y}, false},
                     {{{0.0, 1.0}, -y - 60.0}, false}};
  return detection;
}

Detection AtDepth(Detection detection, double z) {
  detection.points = std::vector<Eigen::Vector3d>(5, {0.0, 0.0, z});
  return detection;
}

TEST(RightLines, BelongToTheObjectOfTheSameDisparity) {
  // At 1 m the disparity is 50 px, at 2 m it is 25 px.
  std::vector<Detection> left = {AtDepth(BoxAt("cup", 100.0, 50.0), 2.0),
                                 AtDepth(BoxAt("cup", 160.0, 50.0), 1.0)};
  const std::vector<Detection> right = {BoxAt("cup", 110.0, 52.0), BoxAt("cup", 75.0, 50.0)};
  EXPECT_EQ(AddLinesOfRight(right, kCameraOfPair, left), 2U);
  EXPECT_EQ(left[0].right_lines[0].line.offset, 75.0);
  EXPECT_EQ(left[1].right_lines[0].line.offset, 110.0);
}

TEST(RightLines, NeedTheLabelTheRowsAndTheDisparity) {
  std::vector<Detection> left = {AtDepth(BoxAt("cup", 100.0, 50.0), 1.0)};
  EXPECT_EQ(AddLinesOfRight(std::vector{BoxAt("book", 50.0, 50.0)}, kCameraOfPair, left), 0U);
  EXPECT_EQ(AddLinesOfRight(std::vector{BoxAt("cup", 50.0, 90.0)}, kCameraOfPair, left), 0U);
  EXPECT_EQ(AddLinesOfRight(std::vector{BoxAt("cup", 80.0, 50.0)}, kCameraOfPair, left), 0U);
  EXPECT_TRUE(left[0].right_lines.empty());
  EXPECT_EQ(AddLinesOfRight(std::vector{BoxAt("cup", 50.0, 50.0)}, kCameraOfPair, left), 1U);
}

TEST(RightLines, WithoutDepthAnyPositiveDisparityWillDo) {
  std::vector<Detection> left = {BoxAt("cup", 100.0, 50.0)};
  EXPECT_EQ(AddLinesOfRight(std::vector{BoxAt("cup", 110.0, 50.0)}, kCameraOfPair, left), 0U);
  EXPECT_EQ(AddLinesOfRight(std::vector{BoxAt("cup", 70.0, 50.0)}, kCameraOfPair, left), 1U);
}

TEST(RightLines, OneMaskBelongsToOneObject) {
  std::vector<Detection> left = {BoxAt("cup", 100.0, 50.0), BoxAt("cup", 104.0, 50.0)};
  EXPECT_EQ(AddLinesOfRight(std::vector{BoxAt("cup", 70.0, 50.0)}, kCameraOfPair, left), 1U);
}

// The object is hidden at its right side, which is known in the left image only.
TEST(RightLines, AreOneSidedWhereThoseOfTheLeftImageAre) {
  std::vector<Detection> left = {BoxAt("cup", 100.0, 50.0)};
  left[0].lines[1].is_one_sided = true;
  Detection right = BoxAt("cup", 70.0, 50.0);
  right.lines[3].is_one_sided = true;
  AddLinesOfRight(std::vector{right}, kCameraOfPair, left);
  std::vector<bool> one_sided;
  for (const SilhouetteLine& line : left[0].right_lines) {
    one_sided.push_back(line.is_one_sided);
  }
  EXPECT_EQ(one_sided, (std::vector<bool>{false, true, false, true}));
}

}  // namespace

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_checks.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(MaskChecks, StemsHaveNoFolderAndNoExtension) {
  EXPECT_EQ(ImageStem("rgb/1305031102.175304.png"), "1305031102.175304");
  EXPECT_EQ(ImageStem("1305031102.175304"), "1305031102.175304");
  EXPECT_EQ(ImageStem("C:\\data\\0012.JPEG"), "0012");
  EXPECT_EQ(ImageStem("0012"), "0012");
  EXPECT_EQ(ImageStem("0012."), "0012.");
  EXPECT_EQ(ImageStem("rgb/"), "");
}

TEST(MaskChecks, OutlinesAreSortedAndThoseWithoutAreaAreRemoved) {
  const auto square = [](double side) {
    return std::vector<Eigen::Vector2d>{{0.0, 0.0}, {side, 0.0}, {side, side}, {0.0, side}};
  };
  FrameMasks frame;
  AddInstance({.label = "cup", .outlines = {square(2.0), square(0.9), square(3.0), {}}}, frame);
  AddInstance({.label = "tv", .outlines = {square(0.9)}}, frame);
  ASSERT_EQ(frame.masks.size(), 1U);
  ASSERT_EQ(frame.masks[0].outlines.size(), 2U);
  EXPECT_EQ(frame.masks[0].outlines[0], square(3.0));
  EXPECT_EQ(frame.masks[0].outlines[1], square(2.0));
  EXPECT_EQ(frame.without_area, 1U);
}

TEST(MaskChecks, LabelsAreMadePrintable) {
  FrameMasks frame;
  AddInstance({.label = "cup\x1b[2J\n\xff", .outlines = {{{0, 0}, {2, 0}, {2, 2}, {0, 2}}}}, frame);
  EXPECT_EQ(frame.masks.at(0).label, "cup?[2J??");
}

TEST(MaskChecks, PointsMayBeOnePixelBeyondTheBorder) {
  const MaskRequest request{.path = {}, .format = {}, .width = 640, .height = 480};
  EXPECT_TRUE(IsNearImage({-0.5, 479.5}, request));
  EXPECT_TRUE(IsNearImage({640.5, -1.5}, request));
  EXPECT_FALSE(IsNearImage({640.6, 0.0}, request));
  EXPECT_FALSE(IsNearImage({0.0, 480.6}, request));
  EXPECT_FALSE(IsNearImage({-1.6, 0.0}, request));
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/detection_lines.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hullslam {
namespace {

const PinholeCamera kCamera = {.fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0};

std::vector<Polygon2> SquarePart(double side) {
  return {{{0.0, 0.0}, {side, 0.0}, {side, side}, {0.0, side}}};
}

TEST(DetectionOutline, LongEdgesGetPoints) {
  const Outline outline = UndistortOutline(SquarePart(120.0), kCamera);
  EXPECT_EQ(outline.contour.size(), 40U);
  EXPECT_EQ(outline.hull.size(), 4U);
}

// An outline may extend far beyond the image. It must not take more memory the larger it is.
TEST(DetectionOutline, TheNumberOfPointsIsBounded) {
  for (const double side : {1e6, 1e9, 1e12}) {
    EXPECT_LE(UndistortOutline(SquarePart(side), kCamera).boundary.size(), 20'010U) << side;
  }
}

TEST(DetectionOutline, SmallPartsAreLeftOut) {
  std::vector<Polygon2> parts = SquarePart(10.0);
  parts.push_back(SquarePart(100.0)[0]);
  parts.push_back(SquarePart(0.5)[0]);
  EXPECT_EQ(LargeParts(parts, 0.001).size(), 2U);
  EXPECT_EQ(LargeParts(parts, 0.5).size(), 1U);
  EXPECT_EQ(LargeParts(parts, 0.001)[0][1].x(), 100.0);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/sort_outlines.h"

#include <gtest/gtest.h>

#include <vector>

#include "geometry/polyline.h"

namespace hullslam {
namespace {

using Outlines = std::vector<std::vector<Eigen::Vector2d>>;

Outlines SquareAt(double side, double x) {
  return {{{x, 0.0}, {x + side, 0.0}, {x + side, side}, {x, side}}};
}

TEST(SortOutlines, OutlinesAreSortedByAreaWhateverTheirDirection) {
  const auto large = SquareAt(4.0, 0.0)[0];
  const auto middle = SquareAt(2.0, 10.0)[0];
  const auto tie = SquareAt(2.0, 20.0)[0];
  const auto small = SquareAt(0.9, 30.0)[0];
  Outlines outlines = {middle, small, {large.rbegin(), large.rend()}, tie};
  SortByArea(outlines);
  EXPECT_EQ(outlines, (Outlines{{large.rbegin(), large.rend()}, middle, tie}));
  EXPECT_LT(SignedArea(outlines[0]), 0.0);
}

}  // namespace
}  // namespace hullslam

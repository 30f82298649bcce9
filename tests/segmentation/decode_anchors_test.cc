// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "segmentation/network_layout.h"

namespace hullslam {
namespace {

// Logits of 0 are sigmoids of 0.5: the centre is in the middle of the cell, and the box has the
// size of the anchor.
TEST(DecodeAnchors, BoxesAreAnchorsThatMoveAndGrow) {
  const NetworkLayout layout = {
      .input = {64, 32}, .class_count = 1, .coefficient_count = 1, .heads = {0}};
  const std::array<int, 4> shape = {1, 3 * 7, 4, 8};
  cv::Mat map(4, shape.data(), CV_32F, cv::Scalar(0));
  for (int anchor = 0; anchor < 3; ++anchor) {
    cv::Mat(4, 8, CV_32F, map.data + map.step[1] * static_cast<size_t>(anchor * 7 + 4)) = -20.0F;
  }
  // The second anchor, 16 x 30 px, of the cell in row 2 and column 5.
  map.ptr<float>(0, 7 + 4, 2)[5] = 20.0F;
  map.ptr<float>(0, 7 + 5, 2)[5] = 20.0F;
  map.ptr<float>(0, 7 + 6, 2)[5] = 0.5F;
  const auto found = DecodeAnchors(layout, std::vector<NetworkOutput>{{"head", map}},
                                   {.min_score = 0.5, .classes = {true}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].least.isApprox(Eigen::Array2d(44.0 - 8.0, 20.0 - 15.0)));
  EXPECT_TRUE(found[0].greatest.isApprox(Eigen::Array2d(44.0 + 8.0, 20.0 + 15.0)));
  EXPECT_NEAR(found[0].score, 1.0, 1e-6);
  EXPECT_EQ(found[0].coefficients, Eigen::VectorXf::Constant(1, 0.5F));
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "segmentation/network_layout.h"

namespace hullslam {
namespace {

NetworkLayout RowLayout() {
  return {.input = {64, 32}, .class_count = 2, .coefficient_count = 1, .heads = {0}};
}

void ExpectBox(const Candidate& candidate) {
  EXPECT_TRUE(candidate.least.isApprox(Eigen::Array2d(10.0, 4.0)));
  EXPECT_TRUE(candidate.greatest.isApprox(Eigen::Array2d(30.0, 16.0)));
  EXPECT_EQ(candidate.class_number, 1);
  EXPECT_EQ(candidate.coefficients, Eigen::VectorXf::Constant(1, -3.0F));
}

// Both forms of the box with centre (20, 10), width 20 and height 12.
TEST(DecodeRows, ReadsColumnsOfYolo8AndRowsOfYolo5) {
  const std::array<int, 3> columns = {1, 7, 2};
  cv::Mat yolo8(3, columns.data(), CV_32F, cv::Scalar(0));
  const std::array<float, 7> values = {20, 10, 20, 12, 0.25F, 0.75F, -3};
  for (int i = 0; i < 7; ++i) {
    yolo8.ptr<float>(0, i)[1] = values.at(static_cast<size_t>(i));
  }
  const CandidateFilter filter = {.min_score = 0.5, .classes = {true, true}};
  const auto of_yolo8 =
      DecodeColumns(RowLayout(), std::vector<NetworkOutput>{{"out", yolo8}}, filter);
  ASSERT_EQ(of_yolo8.size(), 1U);
  ExpectBox(of_yolo8[0]);
  EXPECT_NEAR(of_yolo8[0].score, 0.75, 1e-6);

  const std::array<int, 3> rows = {1, 2, 8};
  cv::Mat yolo5(3, rows.data(), CV_32F, cv::Scalar(0));
  const std::array<float, 8> row = {20, 10, 20, 12, 0.8F, 0.25F, 0.75F, -3};
  std::copy(row.begin(), row.end(), yolo5.ptr<float>(0, 1));
  const auto of_yolo5 = DecodeRows(RowLayout(), std::vector<NetworkOutput>{{"out", yolo5}}, filter);
  ASSERT_EQ(of_yolo5.size(), 1U);
  ExpectBox(of_yolo5[0]);
  EXPECT_NEAR(of_yolo5[0].score, 0.6, 1e-6);  // objectness times class
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/label_image.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>

#include "geometry/polyline.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

using Outlines = std::vector<std::vector<Eigen::Vector2d>>;

// Blocks of 5 x 4 px with numbers from 0 to 6.
cv::Mat LabelBlocks(int type) {
  std::mt19937 random(3);
  cv::Mat labels(32, 40, type, cv::Scalar(0));
  for (int y = 0; y < labels.rows; y += 4) {
    for (int x = 0; x < labels.cols; x += 5) {
      labels(cv::Rect(x, y, 5, 4)) = cv::Scalar(static_cast<double>(random() % 7));
    }
  }
  return labels;
}

Outlines SquareAt(double side, double x) {
  return {{{x, 0.0}, {x + side, 0.0}, {x + side, side}, {x, side}}};
}

TEST(LabelImage, ABoxIsTheSmallestOneAroundTheNumber) {
  for (const int type : {CV_8UC1, CV_16UC1, CV_32SC1}) {
    const cv::Mat labels = LabelBlocks(type);
    const std::map<int, cv::Rect> found = FindInstances(labels);
    EXPECT_EQ(found.count(0), 0u);
    for (int number = 1; number < 7; ++number) {
      const cv::Mat pixels = labels == number;
      const cv::Rect box = found.count(number) > 0 ? found.at(number) : cv::Rect();
      const int all = cv::countNonZero(pixels);
      ASSERT_EQ(all > 0, !box.empty()) << number;
      EXPECT_EQ(cv::countNonZero(pixels(box)), all);
      for (const cv::Mat& side : {pixels(box).row(0), pixels(box).row(box.height - 1),
                                  pixels(box).col(0), pixels(box).col(box.width - 1)}) {
        EXPECT_GT(cv::countNonZero(side), 0) << number;
      }
    }
  }
  EXPECT_THROW(FindInstances(LabelBlocks(CV_32FC1)), CheckError);
}

TEST(LabelImage, LargeNumbersKeepTheirValue) {
  cv::Mat labels(8, 8, CV_32SC1, cv::Scalar(0));
  labels(cv::Rect(2, 3, 4, 2)) = cv::Scalar(1'000'000);
  EXPECT_EQ(FindInstances(labels), (std::map<int, cv::Rect>{{1'000'000, cv::Rect(2, 3, 4, 2)}}));
}

TEST(LabelImage, TheOutlinesOfANumberMoveWithItAndIgnoreTheOthers) {
  cv::Mat labels(40, 50, CV_8UC1, cv::Scalar(0));
  labels(cv::Rect(4, 5, 10, 8)) = cv::Scalar(3);
  labels(cv::Rect(30, 20, 6, 6)) = cv::Scalar(3);  // a second part
  const std::map<int, cv::Rect> found = FindInstances(labels);
  const Outlines alone = OutlinesOf(labels, 3, found.at(3));
  ASSERT_EQ(alone.size(), 2u);
  labels(cv::Rect(14, 5, 7, 8)) = cv::Scalar(5);  // touches the first part
  EXPECT_EQ(OutlinesOf(labels, 3, found.at(3)), alone);

  cv::Mat moved(40, 50, CV_8UC1, cv::Scalar(0));
  labels(cv::Rect(0, 0, 43, 36)).copyTo(moved(cv::Rect(7, 4, 43, 36)));
  const Outlines after = OutlinesOf(moved, 3, FindInstances(moved).at(3));
  ASSERT_EQ(after.size(), alone.size());
  for (size_t i = 0; i < after.size(); ++i) {
    ASSERT_EQ(after[i].size(), alone[i].size());
    for (size_t k = 0; k < after[i].size(); ++k) {
      EXPECT_EQ(after[i][k], alone[i][k] + Eigen::Vector2d(7.0, 4.0));
    }
  }
}

TEST(LabelImage, OutlinesAreSortedByAreaWhateverTheirDirection) {
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/mask_image.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "support/expect_error.h"

namespace hullslam {
namespace {

Eigen::AlignedBox2d BoxOf(const InstanceMask& mask) {
  Eigen::AlignedBox2d box;
  for (const auto& outline : mask.outlines) {
    for (const Eigen::Vector2d& point : outline) {
      box.extend(point);
    }
  }
  return box;
}

// The pixels 10 to 29 end half a pixel beyond the centres of the first and the last one.
void ExpectSides(const InstanceMask& mask, double left, double top, double right, double bottom) {
  const Eigen::AlignedBox2d box = BoxOf(mask);
  EXPECT_EQ(box.min(), Eigen::Vector2d(left, top));
  EXPECT_EQ(box.max(), Eigen::Vector2d(right, bottom));
}

TEST(MaskImage, OutlinesRunBetweenThePixels) {
  cv::Mat image = cv::Mat::zeros(60, 80, CV_8UC1);
  image(cv::Rect(10, 20, 20, 15)).setTo(255);
  const InstanceMask mask = MaskFromImage(image, "cup", 0.5);
  EXPECT_EQ(mask.label, "cup");
  EXPECT_EQ(mask.score, 0.5);
  EXPECT_EQ(mask.shape, MaskShape::kContour);
  ExpectSides(mask, 9.5, 19.5, 29.5, 34.5);
  ValidateMasks({&mask, 1}, image.cols, image.rows);
}

TEST(MaskImage, AMatrixOfBoolIsAMask) {
  cv::Mat_<bool> image(60, 80, false);
  image(cv::Rect(0, 0, 80, 15)).setTo(true);
  ExpectSides(MaskFromImage(image, "table"), -0.5, -0.5, 79.5, 14.5);
  EXPECT_TRUE(MaskFromImage(cv::Mat_<bool>(60, 80, false), "table").outlines.empty());
}

TEST(MaskImage, LabelsOfEveryTypeGiveTheSameMasks) {
  cv::Mat labels = cv::Mat::zeros(60, 80, CV_8UC1);
  labels(cv::Rect(10, 20, 20, 15)).setTo(7);
  labels(cv::Rect(30, 20, 8, 8)).setTo(3);  // touches the other one
  labels(cv::Rect(60, 40, 12, 12)).setTo(3);
  labels.at<uint8_t>(0, 0) = 9;  // too small
  const std::map<int, InstanceClass> classes = {
      {3, {"tv", 0.75}}, {7, {"cup"}}, {8, {"book"}}, {9, {"mouse"}}};
  for (const int type : {CV_8UC1, CV_16UC1, CV_32SC1}) {
    cv::Mat converted;
    labels.convertTo(converted, type);
    const std::vector<InstanceMask> masks = MasksFromLabels(converted, classes);
    ASSERT_EQ(masks.size(), 2u);
    EXPECT_EQ(masks[0].label, "tv");
    EXPECT_EQ(masks[0].score, 0.75);
    ASSERT_EQ(masks[0].outlines.size(), 2u);
    EXPECT_GT(masks[0].outlines[0].front().x(), 50.0) << "the largest part is the first";
    EXPECT_EQ(masks[1].label, "cup");
    EXPECT_EQ(masks[1].score, 1.0);
    ExpectSides(masks[1], 9.5, 19.5, 29.5, 34.5);
  }
}

TEST(MaskImage, OtherImagesAreRefused) {
  const cv::Mat labels(60, 80, CV_16UC1, cv::Scalar(5));
  ExpectInputError([&] { MasksFromLabels(labels, {{4, {"cup"}}}); }, {"instance 5"});
  ExpectInputError([] { MasksFromLabels(cv::Mat::zeros(60, 80, CV_32FC1), {}); }, {"CV_32SC1"});
  ExpectInputError([] { MaskFromImage(cv::Mat::zeros(60, 80, CV_8UC3), "cup"); }, {"CV_8UC1"});
}

}  // namespace
}  // namespace hullslam

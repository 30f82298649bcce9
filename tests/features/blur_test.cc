// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/blur.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "features/test_images.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

int DifferingPixels(const cv::Mat& image, OrbBlur& blur) {
  cv::Mat expected;
  cv::GaussianBlur(image, expected, cv::Size(7, 7), 2.0, 2.0, cv::BORDER_REFLECT_101);
  const cv::Mat& blurred = blur.Blur(image);
  EXPECT_EQ(blurred.size(), image.size());
  return cv::countNonZero(blurred != expected);
}

TEST(OrbBlur, HasTheBitsOfOpenCv) {
  OrbBlur blur;
  EXPECT_EQ(DifferingPixels(MakeCornerImage(), blur), 0);
  cv::RNG random(5);
  for (int i = 0; i < 100; ++i) {
    cv::Mat image(random.uniform(4, 90), random.uniform(4, 90), CV_8UC1);
    random.fill(image, cv::RNG::UNIFORM, 0, 256);
    EXPECT_EQ(DifferingPixels(image, blur), 0) << image.size();
  }
}

// The sums of 16 bits are largest in white images.
TEST(OrbBlur, DoesNotOverflow) {
  OrbBlur blur;
  EXPECT_EQ(DifferingPixels(cv::Mat(20, 50, CV_8UC1, cv::Scalar(255)), blur), 0);
  cv::Mat black_and_white(60, 70, CV_8UC1);
  cv::RNG random(6);
  random.fill(black_and_white, cv::RNG::UNIFORM, 0, 256);
  EXPECT_EQ(DifferingPixels(black_and_white > 40, blur), 0);
}

TEST(OrbBlur, ReadsAPartOfALargerImage) {
  const cv::Mat image = MakeCornerImage();
  OrbBlur blur;
  const cv::Mat of_copy = blur.Blur(image(cv::Rect(30, 40, 101, 77)).clone()).clone();
  EXPECT_EQ(cv::countNonZero(blur.Blur(image(cv::Rect(30, 40, 101, 77))) != of_copy), 0);
}

TEST(OrbBlur, RejectsImagesItCannotRead) {
  OrbBlur blur;
  EXPECT_THROW(blur.Blur(cv::Mat(9, 9, CV_16UC1, cv::Scalar(0))), CheckError);
  EXPECT_THROW(blur.Blur(cv::Mat(3, 9, CV_8UC1, cv::Scalar(0))), CheckError);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/resize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "features/test_images.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

int DifferingPixels(const cv::Mat& image, cv::Size size, ImageShrinker& shrinker) {
  cv::Mat expected;
  cv::resize(image, expected, size, 0.0, 0.0, cv::INTER_LINEAR_EXACT);
  cv::Mat shrunk;
  shrinker.Shrink(image, size, shrunk);
  EXPECT_EQ(shrunk.size(), size);
  return cv::countNonZero(shrunk != expected);
}

TEST(ImageShrinker, HasTheBitsOfOpenCv) {
  ImageShrinker shrinker;
  const cv::Mat image = MakeCornerImage();
  EXPECT_EQ(DifferingPixels(image, {533, 400}, shrinker), 0);
  EXPECT_EQ(DifferingPixels(MakeCornerImage(640, 480, 8), {533, 400}, shrinker), 0);
  EXPECT_EQ(DifferingPixels(image, image.size(), shrinker), 0);
  cv::RNG random(5);
  for (int i = 0; i < 200; ++i) {
    cv::Mat noise(random.uniform(1, 150), random.uniform(1, 150), CV_8UC1);
    random.fill(noise, cv::RNG::UNIFORM, 0, 256);
    const double factor = random.uniform(1.0, 2.2);
    const cv::Size size(std::max(1, cvRound(noise.cols / factor)),
                        std::max(1, cvRound(noise.rows / factor)));
    EXPECT_EQ(DifferingPixels(noise, size, shrinker), 0) << noise.size() << " to " << size;
  }
}

// The sums of 16 bits are largest in white images.
TEST(ImageShrinker, DoesNotOverflow) {
  ImageShrinker shrinker;
  EXPECT_EQ(DifferingPixels(cv::Mat(60, 80, CV_8UC1, cv::Scalar(255)), {67, 50}, shrinker), 0);
}

TEST(ImageShrinker, ReadsAPartOfALargerImage) {
  const cv::Mat part = MakeCornerImage()(cv::Rect(30, 40, 101, 77));
  ImageShrinker shrinker;
  EXPECT_EQ(DifferingPixels(part, {84, 64}, shrinker), 0);
}

TEST(ImageShrinker, RejectsOtherImagesAndLargerSizes) {
  ImageShrinker shrinker;
  cv::Mat shrunk;
  const cv::Mat image(20, 30, CV_8UC1, cv::Scalar(0));
  EXPECT_THROW(shrinker.Shrink(image, {0, 10}, shrunk), CheckError);
  EXPECT_THROW(shrinker.Shrink(image, {31, 20}, shrunk), CheckError);
  EXPECT_THROW(shrinker.Shrink(cv::Mat(20, 30, CV_16UC1, cv::Scalar(0)), {9, 9}, shrunk),
               CheckError);
}

}  // namespace
}  // namespace hullslam

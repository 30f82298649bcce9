// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/pyramid.h"

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

TEST(ImagePyramid, HasTheSizesOfOpenCvsOrb) {
  ImagePyramid pyramid(ScaleLevels::Create(8, 1.2));
  const cv::Mat image = MakeCornerImage();
  pyramid.Build(image);
  const cv::Size expected[] = {{640, 480}, {533, 400}, {444, 333}, {370, 278},
                               {309, 231}, {257, 193}, {214, 161}, {179, 134}};
  for (int l = 0; l < 8; ++l) {
    EXPECT_EQ(pyramid.level(l).size(), expected[l]) << l;
  }
  EXPECT_EQ(pyramid.level(0).data, image.data);
}

TEST(ImagePyramid, MapsTheCornersOfTheImage) {
  ImagePyramid pyramid(ScaleLevels::Create(8, 1.2));
  pyramid.Build(MakeCornerImage());
  for (int l = 0; l < 8; ++l) {
    const cv::Mat& image = pyramid.level(l);
    const Eigen::Vector2f far(static_cast<float>(image.cols) - 0.5f,
                              static_cast<float>(image.rows) - 0.5f);
    EXPECT_LT((pyramid.ToLevelZero({-0.5f, -0.5f}, l) - Eigen::Vector2f(-0.5f, -0.5f)).norm(),
              1e-4f);
    EXPECT_LT((pyramid.ToLevelZero(far, l) - Eigen::Vector2f(639.5f, 479.5f)).norm(), 1e-3f);
  }
  EXPECT_EQ(pyramid.ToLevelZero({17.0f, 23.0f}, 0), Eigen::Vector2f(17.0f, 23.0f));
}

// The centre of gravity of a smooth spot is at the same position on all levels.
TEST(ImagePyramid, MapsThePositionOfASpot) {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(0));
  const Eigen::Vector2f center(560.0f, 400.0f);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const float r2 =
          (Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - center).squaredNorm();
      image.at<uint8_t>(y, x) = static_cast<uint8_t>(250.0f * std::exp(-r2 / 450.0f));
    }
  }
  ImagePyramid pyramid(ScaleLevels::Create(8, 1.2));
  pyramid.Build(image);
  for (int l = 0; l < 8; ++l) {
    const cv::Moments moments = cv::moments(pyramid.level(l));
    const Eigen::Vector2f spot(static_cast<float>(moments.m10 / moments.m00),
                               static_cast<float>(moments.m01 / moments.m00));
    EXPECT_LT((pyramid.ToLevelZero(spot, l) - center).norm(), 0.1f) << l;
    EXPECT_LT((pyramid.FromLevelZero(pyramid.ToLevelZero(spot, l), l) - spot).norm(), 1e-3f) << l;
  }
}

TEST(ImagePyramid, RejectsImagesItCannotRead) {
  ImagePyramid pyramid(ScaleLevels::Create(8, 1.2));
  EXPECT_THROW(pyramid.Build(cv::Mat(64, 64, CV_16UC1, cv::Scalar(0))), CheckError);
  EXPECT_THROW(pyramid.Build(cv::Mat(1, 1, CV_8UC1, cv::Scalar(0))), CheckError);
}

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/stereo_matcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "features/test_images.h"

namespace hullslam {
namespace {

// A slanted plane: its disparity grows from 5 px at the top to 45 px at the bottom of the image.
float Disparity(float row) { return 5.0F + 40.0F * row / 480.0F; }

class StereoMatcherTest : public ::testing::Test {
 protected:
  // The right image of the plane: a column u of the left image is at u - Disparity(v). `down` moves
  // it, as a pair does that is not rectified.
  static cv::Mat RightOf(const cv::Mat& left, float down = 0.0F) {
    cv::Mat columns(left.size(), CV_32FC1);
    cv::Mat rows(left.size(), CV_32FC1);
    for (int y = 0; y < left.rows; ++y) {
      for (int x = 0; x < left.cols; ++x) {
        columns.at<float>(y, x) = static_cast<float>(x) + Disparity(static_cast<float>(y));
        rows.at<float>(y, x) = static_cast<float>(y) - down;
      }
    }
    cv::Mat right;
    cv::remap(left, right, columns, rows, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    return right;
  }

  std::vector<float> Match(const cv::Mat& left, const cv::Mat& right) {
    features_ = left_.Extract(left);
    const ExtractedFeatures others = right_.Extract(right);
    StereoMatcher matcher(left_.levels(), 100.0);
    SerialRunner runner;
    return matcher.Match({features_, left_.pyramid()}, {others, right_.pyramid()}, runner);
  }
  size_t Found(const std::vector<float>& disparities) const {
    return static_cast<size_t>(std::count_if(disparities.begin(), disparities.end(),
                                             [](float disparity) { return disparity > 0.0F; }));
  }

  static float Mean(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0F) / static_cast<float>(values.size());
  }

  FeatureExtractor left_{FeatureOptions()};
  FeatureExtractor right_{FeatureOptions()};
  ExtractedFeatures features_;
};

// Errors are in pixels of the level of the keypoint, where the patches are compared.
TEST_F(StereoMatcherTest, FindsTheDisparitiesOfAPlaneToAFractionOfAPixel) {
  const cv::Mat left = MakeCornerImage();
  const std::vector<float> disparities = Match(left, RightOf(left));
  ASSERT_EQ(disparities.size(), features_.keypoints.size());
  std::vector<float> errors;
  for (size_t i = 0; i < disparities.size(); ++i) {
    if (disparities[i] > 0.0F) {
      const RawKeypoint& keypoint = features_.keypoints[i];
      const float error = std::abs(disparities[i] - Disparity(keypoint.raw.y()));
      errors.push_back(error / left_.levels().scale[static_cast<size_t>(keypoint.level)]);
    }
  }
  EXPECT_GT(errors.size(), disparities.size() / 2);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.15F);
  EXPECT_LT(errors[errors.size() * 95 / 100], 1.0F);
}

// Shapes of all sizes on a plane parallel to the images, which are the means of 4 x 4 finer pixels,
// so that disparities are multiples of a quarter of a pixel.
class FinePlane {
 public:
  FinePlane() {
    cv::RNG random(3);
    for (int i = 0; i < 2500; ++i) {
      const cv::Point2f middle(random.uniform(0.0F, 1.0F) * static_cast<float>(fine_.cols),
                               random.uniform(0.0F, 1.0F) * static_cast<float>(fine_.rows));
      const auto size = static_cast<float>(kFine * std::exp(random.uniform(1.0, 4.0)));
      const cv::RotatedRect shape(middle, {size, size * random.uniform(0.3F, 1.0F)},
                                  random.uniform(0.0F, 360.0F));
      std::array<cv::Point2f, 4> corners;
      shape.points(corners.data());
      std::vector<cv::Point> whole(corners.begin(), corners.end());
      cv::fillConvexPoly(fine_, whole, cv::Scalar(random.uniform(20, 236)));
    }
  }
  // The image whose columns are moved to the left.
  cv::Mat Image(int fine_columns, uint64_t seed) const {
    cv::Mat image;
    cv::resize(fine_.colRange(fine_columns, fine_columns + kFine * 480), image, {480, 360}, 0.0,
               0.0, cv::INTER_AREA);
    cv::Mat noise(image.size(), CV_16SC1);
    cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0.0, 1.5);
    cv::add(image, noise, image, cv::noArray(), CV_8UC1);
    return image;
  }
  static constexpr int kFine = 4;

 private:
  cv::Mat fine_{kFine * 360, kFine * 560, CV_8UC1, cv::Scalar(128)};
};

TEST_F(StereoMatcherTest, ThePlanesOfAllLevelsHaveTheRightDisparity) {
  constexpr float kMost = 0.03F;  // px of the level in one plane, and of level 0 in all of them
  const FinePlane plane;
  const cv::Mat left = plane.Image(0, 1);
  std::array<std::vector<float>, 8> of_all;
  for (const int fine : {80, 93, 110, 123, 136, 149, 166, 179, 202, 217, 240, 263}) {
    const float disparity = static_cast<float>(fine) / FinePlane::kFine;
    const std::vector<float> found = Match(left, plane.Image(fine, 2));
    std::array<std::vector<float>, 8> errors;
    for (size_t i = 0; i < found.size(); ++i) {
      const auto level = static_cast<size_t>(features_.keypoints[i].level);
      const float error = found[i] - disparity;
      if (found[i] > 0.0F && std::abs(error) < left_.levels().scale[level]) {
        errors[level].push_back(error);
        of_all[level].push_back(error);
      }
    }
    for (size_t level = 0; level < errors.size(); ++level) {
      ASSERT_GT(errors[level].size(), 10U);
      EXPECT_LT(std::abs(Mean(errors[level])), 2.0F * kMost * left_.levels().scale[level])
          << "level " << level << " at " << disparity;
    }
  }
  for (size_t level = 0; level < of_all.size(); ++level) {
    EXPECT_LT(std::abs(Mean(of_all[level])), kMost) << "level " << level;
  }
}

// At level 7 two rows are seven of the image.
TEST_F(StereoMatcherTest, UpperLevelsMayBeMoreRowsApart) {
  const cv::Mat left = MakeCornerImage();
  const auto count = [&](float down) {
    const std::vector<float> disparities = Match(left, RightOf(left, down));
    size_t found = 0;
    for (size_t i = 0; i < disparities.size(); ++i) {
      found += features_.keypoints[i].level >= 6 && disparities[i] > 0.0F ? 1 : 0;
    }
    return found;
  };
  EXPECT_GT(count(4.0F), count(0.0F) / 2);
}

// The same things are seen twice in the right image: as noisy ones at 20 px, and as they are at
// 220 px, nearer than the largest disparity allows.
TEST_F(StereoMatcherTest, WhatIsNearerThanTheBaselineHidesNothing) {
  const cv::Mat things = MakeCornerImage();
  const cv::Rect square(300, 100, 150, 250);
  cv::Mat left(things.size(), CV_8UC1, cv::Scalar(120));
  things(square).copyTo(left(square));
  cv::Mat noise(square.size(), CV_16SC1);
  cv::RNG(5).fill(noise, cv::RNG::NORMAL, 0.0, 12.0);
  cv::Mat noisy;
  cv::add(things(square), noise, noisy, cv::noArray(), CV_8UC1);
  cv::Mat right(things.size(), CV_8UC1, cv::Scalar(120));
  noisy.copyTo(right(square - cv::Point(20, 0)));
  const auto alone = Found(Match(left, right));
  ASSERT_GT(alone, 80U);
  things(square).copyTo(right(square - cv::Point(220, 0)));
  const auto both = Found(Match(left, right));
  EXPECT_GT(both, alone / 2);
}

// Squares of 60 px at a disparity of 30 px before a background at 22 px.
TEST_F(StereoMatcherTest, TheBackgroundBesideAnObjectMovesItsDisparityLittle) {
  constexpr int kSide = 60;
  constexpr int kOfSquares = 30;
  constexpr int kOfBackground = 22;
  const cv::Mat front = MakeCornerImage(640, 480, 8);
  cv::Mat left = MakeCornerImage();
  cv::Mat right(left.size(), CV_8UC1, cv::Scalar(128));
  left.colRange(kOfBackground, 640).copyTo(right.colRange(0, 640 - kOfBackground));
  std::vector<cv::Rect> squares;
  for (int y = 40; y + kSide < 460; y += 2 * kSide) {
    for (int x = 40; x + kSide < 620; x += 2 * kSide) {
      const cv::Rect square(x, y, kSide, kSide);
      front(square).copyTo(left(square));
      front(square).copyTo(right(square - cv::Point(kOfSquares, 0)));
      squares.push_back(square);
    }
  }
  const std::vector<float> disparities = Match(left, right);
  size_t count = 0;
  double sum = 0.0;  // of the errors in pixels of the level, those of wrong matches as 2
  for (size_t i = 0; i < disparities.size(); ++i) {
    const RawKeypoint& keypoint = features_.keypoints[i];
    const cv::Point pixel(static_cast<int>(keypoint.raw.x()), static_cast<int>(keypoint.raw.y()));
    const bool is_on_square = std::ranges::any_of(
        squares, [&](const cv::Rect& square) { return square.contains(pixel); });
    if (disparities[i] > 0.0F && is_on_square) {
      const float error =
          (disparities[i] - kOfSquares) / left_.levels().scale[static_cast<size_t>(keypoint.level)];
      sum += static_cast<double>(std::clamp(error, -2.0F, 2.0F));
      ++count;
    }
  }
  ASSERT_GT(count, 100U);
  EXPECT_LT(std::abs(sum / static_cast<double>(count)), 0.035) << "0.045 with equal weights";
}

TEST_F(StereoMatcherTest, ADarkerRightImageChangesNothing) {
  const cv::Mat left = MakeCornerImage();
  const size_t found = Found(Match(left, RightOf(left)));
  const cv::Mat darker = RightOf(left) * 0.8;
  EXPECT_GT(Found(Match(left, darker)), found * 8 / 10);
}

// Points that are to the right of where they are on the left would be behind the camera.
TEST_F(StereoMatcherTest, SwappedImagesHaveFewMatches) {
  const cv::Mat left = MakeCornerImage();
  const cv::Mat right = RightOf(left);
  const size_t found = Found(Match(left, right));
  EXPECT_LT(Found(Match(right, left)), found / 4);
}

TEST_F(StereoMatcherTest, ImagesOfDifferentThingsHaveFewMatches) {
  const cv::Mat left = MakeCornerImage();
  const size_t found = Found(Match(left, RightOf(left)));
  EXPECT_LT(Found(Match(left, MakeCornerImage(640, 480, 8))), found / 4);
  EXPECT_EQ(Found(Match(left, cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)))), 0u);
  EXPECT_EQ(Found(Match(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)), left)), 0u);
}

TEST_F(StereoMatcherTest, RowsThatAreFarApartAreNotCompared) {
  const cv::Mat left = MakeCornerImage();
  const size_t found = Found(Match(left, RightOf(left)));
  EXPECT_LT(Found(Match(left, RightOf(left, 25.0F))), found / 3);
}

TEST_F(StereoMatcherTest, TheSameImagesGiveTheSameBits) {
  const cv::Mat left = MakeCornerImage();
  const cv::Mat right = RightOf(left);
  EXPECT_EQ(Match(left, right), Match(left, right));
}

TEST(StereoFeatures, FindsTheDisparityOfKeypoints) {
  const PinholeCamera camera{.fx = 500.0, .fy = 500.0, .cx = 319.5, .cy = 239.5, .bf = 60.0};
  const cv::Mat left = MakeCornerImage();
  const int disparity = 30;
  cv::Mat right(left.size(), CV_8UC1, cv::Scalar(120));
  left.colRange(disparity, left.cols).copyTo(right.colRange(0, left.cols - disparity));
  FeatureExtractor extractor{FeatureOptions()};
  StereoFeatures stereo(FeatureOptions(), camera);
  SerialRunner runner;
  ExtractedFeatures features = stereo.Extract(extractor, left, right, runner);
  features.keypoints.pop_back();  // as if it were on something that moves
  features.descriptors.pop_back();
  const std::vector<float> found = stereo.FindDisparities(features, extractor.pyramid(), runner);
  ASSERT_EQ(found.size(), features.keypoints.size());
  size_t known = 0;
  size_t exact = 0;
  for (const float disparity_found : found) {
    known += disparity_found > 0.0F ? 1 : 0;
    exact += std::abs(disparity_found - 30.0F) < 1.5F ? 1 : 0;  // half a pixel at upper levels
  }
  EXPECT_GT(known, found.size() * 4 / 10) << "the others have no keypoint in the right image";
  EXPECT_GT(exact, known * 9 / 10);
}

}  // namespace

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/extractor.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "features/test_images.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

bool SameBits(const ExtractedFeatures& a, const ExtractedFeatures& b) {
  if (a.keypoints.size() != b.keypoints.size() || a.descriptors != b.descriptors) {
    return false;
  }
  for (size_t i = 0; i < a.keypoints.size(); ++i) {
    const RawKeypoint& p = a.keypoints[i];
    const RawKeypoint& q = b.keypoints[i];
    if (p.raw != q.raw || p.angle != q.angle || p.response != q.response || p.level != q.level) {
      return false;
    }
  }
  return true;
}

TEST(FeatureExtractor, FindsAboutTheRequestedNumber) {
  for (const int wanted : {1, 100, 1000}) {
    FeatureOptions options;
    options.feature_count = wanted;
    FeatureExtractor extractor(options);
    const auto found = static_cast<int>(extractor.Extract(MakeCornerImage()).keypoints.size());
    EXPECT_GE(found, wanted - wanted / 10);
    EXPECT_LE(found, wanted + 2 * options.level_count);
  }
}

// The left two thirds of the image are ignored. The rest has as many corners as are wanted.
TEST(FeatureExtractor, FindsAsManyBesideWhatIsIgnored) {
  FeatureOptions options;
  options.feature_count = 300;
  const cv::Mat image = MakeCornerImage();
  cv::Mat ignored = cv::Mat::zeros(image.size(), CV_8UC1);
  ignored.colRange(0, 430).setTo(255);
  FeatureExtractor extractor(options);
  SerialRunner runner;
  const size_t all = extractor.Extract(image, runner).keypoints.size();
  const ExtractedFeatures features = extractor.Extract(image, runner, ignored);
  EXPECT_GT(features.keypoints.size(), all * 9 / 10);
  ASSERT_EQ(features.keypoints.size(), features.descriptors.size());
  for (const RawKeypoint& keypoint : features.keypoints) {
    EXPECT_FALSE(IsIgnored(ignored, keypoint.raw)) << keypoint.raw.transpose();
  }
  EXPECT_THROW(extractor.Extract(image, runner, ignored.colRange(0, 100)), CheckError);
}

TEST(FeatureExtractor, AMaskThatIgnoresNothingChangesNothing) {
  const cv::Mat image = MakeCornerImage();
  FeatureExtractor extractor(FeatureOptions{});
  SerialRunner runner;
  const ExtractedFeatures without = extractor.Extract(image, runner);
  EXPECT_TRUE(
      SameBits(extractor.Extract(image, runner, cv::Mat::zeros(image.size(), CV_8UC1)), without));
}

// Each image of a pair has its own mask.
TEST(FeatureExtractor, BothImagesOfAPairMayIgnorePixels) {
  const cv::Mat image = MakeCornerImage();
  cv::Mat left = cv::Mat::zeros(image.size(), CV_8UC1);
  left.colRange(0, 300).setTo(255);
  cv::Mat right = cv::Mat::zeros(image.size(), CV_8UC1);
  right.rowRange(200, image.rows).setTo(255);
  FeatureExtractor a(FeatureOptions{}), b(FeatureOptions{});
  SerialRunner runner;
  const auto both = FeatureExtractor::ExtractPair({&a, &b}, {image, image}, runner, {left, right});
  EXPECT_TRUE(SameBits(both[0], FeatureExtractor(FeatureOptions{}).Extract(image, runner, left)));
  EXPECT_TRUE(SameBits(both[1], FeatureExtractor(FeatureOptions{}).Extract(image, runner, right)));
}

TEST(FeatureExtractor, KeypointsAreValid) {
  FeatureExtractor extractor(FeatureOptions{});
  const ExtractedFeatures features = extractor.Extract(MakeCornerImage());
  ASSERT_EQ(features.keypoints.size(), features.descriptors.size());
  int last_level = 0;
  for (const RawKeypoint& keypoint : features.keypoints) {
    EXPECT_GE(keypoint.level, last_level);
    last_level = keypoint.level;
    const float border = 18.0f * extractor.levels().scale[static_cast<size_t>(keypoint.level)];
    EXPECT_GT(keypoint.raw.x(), border);
    EXPECT_LT(keypoint.raw.x(), 640.0f - border);
    EXPECT_GT(keypoint.raw.y(), border);
    EXPECT_LT(keypoint.raw.y(), 480.0f - border);
    EXPECT_GE(keypoint.angle, 0.0f);
    EXPECT_LT(keypoint.angle, 2.0f * std::numbers::pi_v<float>);
    EXPECT_GE(keypoint.response, 7.0f);
  }
  EXPECT_EQ(last_level, 7);
}

TEST(FeatureExtractor, IsReproducible) {
  const cv::Mat image = MakeCornerImage();
  FeatureExtractor extractor(FeatureOptions{});
  const ExtractedFeatures first = extractor.Extract(image);
  extractor.Extract(MakeCornerImage(320, 200, 99));  // leaves buffers of another size
  EXPECT_TRUE(SameBits(first, extractor.Extract(image)));
  EXPECT_TRUE(SameBits(first, FeatureExtractor(FeatureOptions{}).Extract(image)));
}

TEST(FeatureExtractor, ReadsAPartOfALargerImage) {
  const cv::Mat large = MakeCornerImage(800, 600);
  const cv::Mat part = large(cv::Rect(50, 60, 640, 480));
  FeatureExtractor extractor(FeatureOptions{});
  const ExtractedFeatures of_copy = extractor.Extract(part.clone());
  EXPECT_GT(of_copy.keypoints.size(), 500u);
  cv::Mat isolated = part;
  EXPECT_EQ(extractor.Extract(isolated).keypoints.size(), of_copy.keypoints.size());
}

TEST(FeatureExtractor, FindsNothingInAFlatImage) {
  const cv::Mat flat(480, 640, CV_8UC1, cv::Scalar(77));
  EXPECT_TRUE(FeatureExtractor(FeatureOptions{}).Extract(flat).keypoints.empty());
}

TEST(FeatureExtractor, WorksOnTheSmallestImage) {
  FeatureExtractor extractor(FeatureOptions{});
  EXPECT_FALSE(extractor.Extract(MakeCornerImage(64, 64)).keypoints.empty());
}

TEST(FeatureExtractor, FindsWeakCornersInCellsWithoutStrongOnes) {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(100));
  cv::rectangle(image, cv::Rect(100, 100, 40, 40), cv::Scalar(110), cv::FILLED);  // contrast 10
  FeatureOptions options;
  options.level_count = 1;
  EXPECT_FALSE(FeatureExtractor(options).Extract(image).keypoints.empty());
  options.minimum_fast_threshold = 12;
  EXPECT_TRUE(FeatureExtractor(options).Extract(image).keypoints.empty());
}

// Features on a straight edge only fill up half of the wanted number.
TEST(FeatureExtractor, FindsFeaturesOnAStraightEdgeOnlyWhereOthersAreFew) {
  cv::Mat image = MakeDottedEdge(320, 240);
  FeatureOptions options;
  options.level_count = 1;
  options.feature_count = 16;
  options.keep_edges = true;
  const auto count = [&] { return FeatureExtractor(options).Extract(image).keypoints.size(); };
  EXPECT_GE(count(), 16u);
  options.keep_edges = false;
  EXPECT_LE(count(), 10u) << "half, and up to two more";
  EXPECT_GE(count(), 8u);
  for (int i = 0; i < 8; ++i) {
    image(cv::Rect(60, 30 + 20 * i, 3, 3)).setTo(85);  // dots that are not beside the edge
  }
  const auto found = FeatureExtractor(options).Extract(image).keypoints;
  ASSERT_EQ(found.size(), 8u);
  for (const RawKeypoint& keypoint : found) {
    EXPECT_NEAR(keypoint.raw.x(), 61.0f, 3.0f);
  }
}

TEST(FeatureExtractor, APairHasTheFeaturesOfItsImages) {
  const std::array<cv::Mat, 2> images{MakeCornerImage(), MakeCornerImage(640, 480, 8)};
  FeatureOptions few;
  few.level_count = 3;
  FeatureExtractor first{FeatureOptions()};
  FeatureExtractor second(few);
  SerialRunner runner;
  const auto pair = FeatureExtractor::ExtractPair({&first, &second}, images, runner);
  const ExtractedFeatures alone = FeatureExtractor{FeatureOptions()}.Extract(images[0]);
  const ExtractedFeatures other = FeatureExtractor(few).Extract(images[1]);
  ASSERT_GT(other.descriptors.size(), 100u);
  EXPECT_EQ(pair[0].descriptors, alone.descriptors);
  EXPECT_EQ(pair[1].descriptors, other.descriptors);
  EXPECT_THROW(FeatureExtractor::ExtractPair({&first, &second}, {images[0], cv::Mat()}, runner),
               CheckError);
}

// Every keypoint has features on its own level or on a neighbouring one, and there are more of
// them.
TEST(FeatureExtractor, HalfOfTheLevelsHaveTheFeaturesOfAll) {
  const cv::Mat image = MakeCornerImage();
  const ExtractedFeatures all = FeatureExtractor{FeatureOptions()}.Extract(image);
  const ExtractedFeatures half = FeatureExtractor(FeatureOptions(), true).Extract(image);
  EXPECT_GT(half.keypoints.size(), all.keypoints.size());
  std::set<int> levels;
  for (const RawKeypoint& keypoint : half.keypoints) {
    levels.insert(keypoint.level);
  }
  EXPECT_EQ(levels, (std::set<int>{0, 2, 4, 6}));
  FeatureOptions one;
  one.level_count = 1;
  EXPECT_GT(FeatureExtractor(one, true).Extract(image).keypoints.size(), 100u);
}

TEST(FeatureExtractor, SubpixelOnlyChangesPositions) {
  const cv::Mat image = MakeCornerImage();
  FeatureOptions options;
  options.subpixel = false;
  const ExtractedFeatures whole = FeatureExtractor(options).Extract(image);
  options.subpixel = true;
  FeatureExtractor extractor(options);
  const ExtractedFeatures refined = extractor.Extract(image);
  ASSERT_EQ(whole.keypoints.size(), refined.keypoints.size());
  EXPECT_EQ(whole.descriptors, refined.descriptors);
  size_t moved = 0;
  for (size_t i = 0; i < whole.keypoints.size(); ++i) {
    const RawKeypoint& keypoint = refined.keypoints[i];
    const float scale = extractor.levels().scale[static_cast<size_t>(keypoint.level)];
    const Eigen::Vector2f offset = keypoint.raw - whole.keypoints[i].raw;
    EXPECT_LE(offset.cwiseAbs().maxCoeff(), 0.51f * scale);
    moved += offset.norm() > 0.0f ? 1 : 0;
  }
  EXPECT_GT(moved, whole.keypoints.size() / 2);
}

// The dot is small compared with the FAST circle. A wider dot would reach the circle, and then the
// score would be highest beside the centre of the dot.
cv::Mat MakeDot(const Eigen::Vector2f& pixel_of_dot) {
  cv::Mat image(128, 128, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const Eigen::Vector2f pixel(static_cast<float>(x), static_cast<float>(y));
      const float r2 = (pixel - pixel_of_dot).squaredNorm();
      image.at<uint8_t>(y, x) = static_cast<uint8_t>(30.5f + 200.0f * std::exp(-r2 / 2.0f));
    }
  }
  return image;
}

// Mean distance between the only feature and its dot, over positions within a pixel.
float MeanErrorOfDots(bool subpixel) {
  FeatureOptions options;
  options.level_count = 1;
  options.subpixel = subpixel;
  FeatureExtractor extractor(options);
  float sum = 0.0f;
  constexpr int kSteps = 10;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const Eigen::Vector2f pixel_of_dot(60.0f + static_cast<float>(i % kSteps) / kSteps,
                                       70.0f + static_cast<float>(i / kSteps) / kSteps);
    const ExtractedFeatures features = extractor.Extract(MakeDot(pixel_of_dot));
    EXPECT_EQ(features.keypoints.size(), 1u);
    sum += features.keypoints.empty() ? 1.0f : (features.keypoints[0].raw - pixel_of_dot).norm();
  }
  return sum / (kSteps * kSteps);
}

// Without refinement the mean error is 0.38 px. The score is not exactly a parabola, so some error
// remains.
TEST(FeatureExtractor, SubpixelHalvesTheErrorOfDots) {
  const float whole = MeanErrorOfDots(false);
  EXPECT_NEAR(whole, 0.38f, 0.02f);
  EXPECT_LT(MeanErrorOfDots(true), 0.5f * whole);
}

TEST(FeatureExtractor, RejectsImagesItCannotRead) {
  FeatureExtractor extractor(FeatureOptions{});
  EXPECT_THROW(extractor.Extract(cv::Mat()), CheckError);
  EXPECT_THROW(extractor.Extract(cv::Mat(480, 640, CV_8UC3, cv::Scalar())), CheckError);
  EXPECT_THROW(extractor.Extract(cv::Mat(63, 640, CV_8UC1, cv::Scalar())), CheckError);
}

}  // namespace
}  // namespace hullslam

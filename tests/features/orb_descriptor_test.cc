// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/orb_descriptor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/features2d.hpp>
#include <vector>

#include "features/extractor.h"
#include "features/pyramid.h"
#include "features/test_images.h"

namespace hullslam {
namespace {

constexpr float kDegreesPerRadian = 180.0f / std::numbers::pi_v<float>;

struct Described {
  std::vector<cv::KeyPoint> keypoints;
  std::vector<Descriptor> descriptors;
};

cv::Point LevelPixel(const RawKeypoint& keypoint, const cv::Mat& image, const cv::Mat& level) {
  const float ratio_x = static_cast<float>(level.cols) / static_cast<float>(image.cols);
  const float ratio_y = static_cast<float>(level.rows) / static_cast<float>(image.rows);
  return {cvRound((keypoint.raw.x() + 0.5f) * ratio_x - 0.5f),
          cvRound((keypoint.raw.y() + 0.5f) * ratio_y - 0.5f)};
}

// OpenCV's ORB blurs each level inside a larger buffer, with another arithmetic than for whole
// images, so some pixels differ by one grey level. This function blurs in the same way, so that
// everything else can be compared exactly.
cv::Mat BlurInsideLargerImage(const cv::Mat& image) {
  constexpr int kBorder = 32;
  cv::Mat larger;
  cv::copyMakeBorder(image, larger, kBorder, kBorder, kBorder, kBorder, cv::BORDER_REFLECT_101);
  cv::Mat part = larger(cv::Rect(kBorder, kBorder, image.cols, image.rows));
  cv::GaussianBlur(part, part, cv::Size(7, 7), 2.0, 2.0, cv::BORDER_REFLECT_101);
  return part;
}

// The keypoints of the extractor in the form of cv::ORB (the position is the pixel of the level
// times the scale), with our descriptors: those of the extractor if `blur` returns empty images,
// else computed anew from the levels blurred by `blur`.
template <typename Blur>
Described DescribeBy(const cv::Mat& image, int level_count, const Blur& blur) {
  FeatureOptions options;
  options.level_count = level_count;
  options.subpixel = false;  // cv::ORB describes whole pixels
  FeatureExtractor extractor(options);
  const ExtractedFeatures features = extractor.Extract(image);
  ImagePyramid pyramid(extractor.levels());
  pyramid.Build(image);
  std::vector<cv::Mat> blurred;
  for (int l = 0; l < level_count; ++l) {
    blurred.push_back(blur(pyramid.level(l)));
  }
  Described result;
  for (size_t i = 0; i < features.keypoints.size(); ++i) {
    const RawKeypoint& keypoint = features.keypoints[i];
    const auto l = static_cast<size_t>(keypoint.level);
    const cv::Mat& level = pyramid.level(keypoint.level);
    const cv::Point pixel = LevelPixel(keypoint, image, level);
    const float scale = extractor.levels().scale[l];
    result.keypoints.emplace_back(cv::Point2f(pixel) * scale, 31.0f * scale,
                                  keypoint.angle * kDegreesPerRadian, keypoint.response,
                                  keypoint.level);
    result.descriptors.push_back(
        blurred[l].empty()
            ? features.descriptors[i]
            : ComputeDescriptor(blurred[l], pixel, ComputeOrientation(level, pixel)));
  }
  return result;
}

Descriptor FromOpenCv(const cv::Mat& row) {
  Descriptor descriptor{};
  for (int byte = 0; byte < 32; ++byte) {
    descriptor[static_cast<size_t>(byte / 8)] |= static_cast<uint64_t>(row.at<uint8_t>(byte))
                                                 << (8 * (byte % 8));
  }
  return descriptor;
}

// Share of the bits that differ from the bits of cv::ORB for the same keypoints.
double DifferingBits(const cv::Mat& image, int level_count, Described ours) {
  const size_t count = ours.keypoints.size();
  EXPECT_GT(count, 500u);
  cv::Mat theirs;
  cv::ORB::create(2000, 1.2f, level_count, 1)->compute(image, ours.keypoints, theirs);
  EXPECT_EQ(ours.keypoints.size(), count) << "OpenCV dropped keypoints";
  if (ours.keypoints.size() != count) {
    return 1.0;
  }
  int different = 0;
  for (size_t i = 0; i < count; ++i) {
    different += HammingDistance(ours.descriptors[i], FromOpenCv(theirs.row(static_cast<int>(i))));
  }
  return different / (256.0 * static_cast<double>(count));
}

// With OpenCV's blur almost all bits are equal; a few of a hundred thousand differ. The reason is
// that OpenCV computes cosine and sine from an angle in degrees, with other rounding, so a rotated
// test point on the border between two pixels can fall into the other one.
void ExpectOpenCvsBits(const cv::Mat& image, int level_count) {
  const Described exact = DescribeBy(image, level_count, BlurInsideLargerImage);
  EXPECT_LE(DifferingBits(image, level_count, exact), 5e-5);
  const auto keep = [](const cv::Mat&) { return cv::Mat(); };
  const Described extracted = DescribeBy(image, level_count, keep);
  // A difference of one grey level changes most bits in flat areas, and the synthetic image has
  // many.
  EXPECT_LE(DifferingBits(image, level_count, extracted), 1e-2);
}

TEST(OrbDescriptor, EqualsOpenCvOnOneLevel) { ExpectOpenCvsBits(MakeCornerImage(), 1); }

TEST(OrbDescriptor, EqualsOpenCvOnAllLevels) { ExpectOpenCvsBits(MakeCornerImage(), 8); }

TEST(OrbDescriptor, EqualsOpenCvOnRealImage) {
  const cv::Mat image = LoadRealImage();
  if (image.empty()) {
    GTEST_SKIP() << "the images of fr1_xyz are not on this machine";
  }
  ExpectOpenCvsBits(image, 1);
  ExpectOpenCvsBits(image, 8);
}

// cv::ORB::detect() gives every keypoint the angle of its own patch.
TEST(OrbDescriptor, OrientationAgreesWithOpenCv) {
  const cv::Mat image = MakeCornerImage();
  std::vector<cv::KeyPoint> keypoints;
  cv::ORB::create(500, 1.2f, 1)->detect(image, keypoints);
  ASSERT_GT(keypoints.size(), 300u);
  for (const cv::KeyPoint& keypoint : keypoints) {
    const float angle = ComputeOrientation(image, keypoint.pt).Angle();
    const float difference = std::remainder(angle * kDegreesPerRadian - keypoint.angle, 360.0f);
    EXPECT_NEAR(difference, 0.0f, 0.4f);  // OpenCV's arc tangent is good to 0.3 degrees
  }
}

TEST(OrbDescriptor, OrientationPointsToTheBrightSide) {
  const auto angle_of = [](int dx, int dy) {
    cv::Mat image(64, 64, CV_8UC1, cv::Scalar(10));
    image.at<uint8_t>(32 + dy, 32 + dx) = 200;
    return ComputeOrientation(image, {32, 32}).Angle();
  };
  constexpr float kQuarter = std::numbers::pi_v<float> / 2.0f;
  EXPECT_FLOAT_EQ(angle_of(15, 0), 0.0f);
  EXPECT_FLOAT_EQ(angle_of(0, 15), kQuarter);
  EXPECT_FLOAT_EQ(angle_of(-15, 0), 2.0f * kQuarter);
  EXPECT_FLOAT_EQ(angle_of(0, -15), 3.0f * kQuarter);
  EXPECT_FLOAT_EQ(angle_of(7, 7), 0.5f * kQuarter);
  EXPECT_FLOAT_EQ(angle_of(3, 15), std::atan2(15.0f, 3.0f));
  EXPECT_EQ(angle_of(4, 15), 0.0f) << "outside the disc";
  EXPECT_EQ(angle_of(16, 0), 0.0f) << "outside the disc";
}

TEST(OrbDescriptor, AngleIsBelowAFullTurn) {
  const Orientation just_below{.cosine = 1.0f, .sine = -1e-12f};
  EXPECT_EQ(just_below.Angle(), 0.0f);
  const Orientation backwards{.cosine = 0.0f, .sine = -1.0f};
  EXPECT_FLOAT_EQ(backwards.Angle(), 1.5f * std::numbers::pi_v<float>);
}

// Rotating patch and direction by a right angle only permutes pixels, so no bit may change.
TEST(OrbDescriptor, RotatesWithThePatch) {
  cv::Mat patch = MakeCornerImage(39, 39);
  const cv::Point center(19, 19);
  const Orientation orientation = ComputeOrientation(patch, center);
  // Unless the angle is a multiple of a right angle, no rotated test point lies half way between
  // two pixels.
  ASSERT_GT(std::abs(orientation.cosine * orientation.sine), 0.01f);
  const Descriptor before = ComputeDescriptor(patch, center, orientation);
  cv::Mat turned;
  cv::rotate(patch, turned, cv::ROTATE_90_CLOCKWISE);
  const Orientation after = ComputeOrientation(turned, center);
  EXPECT_FLOAT_EQ(after.cosine, -orientation.sine);
  EXPECT_FLOAT_EQ(after.sine, orientation.cosine);
  EXPECT_EQ(HammingDistance(before, ComputeDescriptor(turned, center, after)), 0);
}

// Test 0 compares (8, -3) with (9, 5); test 255 compares (-1, -6) with (0, -11).
TEST(OrbDescriptor, BitsAreInTheOrderOfTheTests) {
  cv::Mat patch(39, 39, CV_8UC1, cv::Scalar(100));
  const cv::Point center(19, 19);
  EXPECT_EQ(ComputeDescriptor(patch, center, {}), Descriptor{}) << "equal pixels give 0";
  patch.at<uint8_t>(19 + 5, 19 + 9) = 101;
  EXPECT_EQ(ComputeDescriptor(patch, center, {})[0] & 1u, 1u);
  patch.at<uint8_t>(19 - 6, 19 - 1) = 99;
  EXPECT_EQ(ComputeDescriptor(patch, center, {})[3] >> 63, 1u);
}

}  // namespace
}  // namespace hullslam

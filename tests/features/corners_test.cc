// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/corners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <tuple>
#include <utility>

#include "features/test_images.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

constexpr int kBorder = 19;

std::vector<Corner> Detect(const cv::Mat& image, int initial_threshold, int minimum_threshold) {
  std::vector<Corner> corners;
  CornerDetector(initial_threshold, minimum_threshold).Detect(image, kBorder, corners);
  return corners;
}

// Positions and scores of OpenCV's corners. Without non-maximum suppression OpenCV finds all FAST
// corners.
std::map<std::pair<int, int>, int> OpenCvScores(const cv::Mat& image, int threshold) {
  std::vector<cv::KeyPoint> keypoints;
  cv::FAST(image, keypoints, threshold, false);
  std::map<std::pair<int, int>, int> scores;
  for (const cv::KeyPoint& keypoint : keypoints) {
    scores[{static_cast<int>(keypoint.pt.x), static_cast<int>(keypoint.pt.y)}] = 0;
  }
  cv::FAST(image, keypoints, threshold, true);
  for (const cv::KeyPoint& keypoint : keypoints) {
    scores[{static_cast<int>(keypoint.pt.x), static_cast<int>(keypoint.pt.y)}] =
        static_cast<int>(keypoint.response);
  }
  return scores;
}

// If two neighbours have the same score, OpenCV drops both, and our detector keeps the first. So
// our result contains all of OpenCV's maxima with the same scores, and all others are FAST corners
// too.
TEST(CornerDetector, AgreesWithOpenCvsFast) {
  const cv::Mat image = MakeCornerImage();
  constexpr int kThreshold = 10;
  const auto theirs = OpenCvScores(image, kThreshold);
  std::map<std::pair<int, int>, int> ours;
  for (const Corner& corner : Detect(image, kThreshold, kThreshold)) {
    ours[{corner.x, corner.y}] = corner.score;
    EXPECT_TRUE(theirs.contains({corner.x, corner.y})) << corner.x << " " << corner.y;
  }
  EXPECT_GT(ours.size(), 500u);
  for (const auto& [position, score] : theirs) {
    const auto [x, y] = position;
    const bool inside = x >= kBorder && y >= kBorder && x < 640 - kBorder && y < 480 - kBorder;
    if (score > 0 && inside) {
      const auto found = ours.find(position);
      ASSERT_NE(found, ours.end()) << x << " " << y;
      EXPECT_EQ(found->second, score);
    }
  }
}

// A dot that is brighter by 50 than its whole circle is a corner at all thresholds below 50.
TEST(CornerDetector, ScoreIsTheLargestThreshold) {
  for (const int sign : {-1, 1}) {
    cv::Mat image(64, 64, CV_8UC1, cv::Scalar(100));
    image.at<uint8_t>(30, 33) = static_cast<uint8_t>(100 + sign * 50);
    const std::vector<Corner> corners = Detect(image, 49, 49);
    ASSERT_EQ(corners.size(), 1u);
    EXPECT_EQ(corners[0].x, 33);
    EXPECT_EQ(corners[0].y, 30);
    EXPECT_EQ(corners[0].score, 49);
    EXPECT_TRUE(Detect(image, 50, 50).empty());
  }
}

TEST(CornerDetector, NeedsNineNeighboursInARow) {
  constexpr int kCircle[16][2] = {{0, -3}, {1, -3},  {2, -2},  {3, -1}, {3, 0},  {3, 1},
                                  {2, 2},  {1, 3},   {0, 3},   {-1, 3}, {-2, 2}, {-3, 1},
                                  {-3, 0}, {-3, -1}, {-2, -2}, {-1, -3}};
  for (int start = 0; start < 16; ++start) {
    for (const int length : {8, 9}) {
      cv::Mat image(41, 41, CV_8UC1, cv::Scalar(100));
      for (int i = start; i < start + length; ++i) {
        image.at<uint8_t>(20 + kCircle[i % 16][1], 20 + kCircle[i % 16][0]) = 180;
      }
      bool found = false;
      for (const Corner& corner : Detect(image, 20, 20)) {
        found = found || (corner.x == 20 && corner.y == 20);
      }
      EXPECT_EQ(found, length == 9) << "from " << start;
    }
  }
}

TEST(CornerDetector, KeepsTheFirstOfEqualNeighbours) {
  cv::Mat image(64, 64, CV_8UC1, cv::Scalar(100));
  image(cv::Rect(30, 30, 2, 2)).setTo(160);
  const std::vector<Corner> corners = Detect(image, 20, 20);
  ASSERT_EQ(corners.size(), 1u);
  EXPECT_EQ(corners[0].x, 30);
  EXPECT_EQ(corners[0].y, 30);
}

TEST(CornerDetector, FindsExtremesOfTheGreyRange) {
  cv::Mat image(64, 64, CV_8UC1, cv::Scalar(0));
  image.at<uint8_t>(32, 32) = 255;
  const std::vector<Corner> corners = Detect(image, 20, 7);
  ASSERT_EQ(corners.size(), 1u);
  EXPECT_EQ(corners[0].score, 254);
  EXPECT_TRUE(Detect(cv::Mat(64, 64, CV_8UC1, cv::Scalar(255)), 1, 1).empty());
}

// A weak dot is dropped if a strong one is in the same cell, and kept if it is alone in its cell.
TEST(CornerDetector, UsesTheMinimumThresholdInCellsWithoutStrongCorners) {
  cv::Mat image(128, 128, CV_8UC1, cv::Scalar(100));
  image.at<uint8_t>(40, 40) = 150;
  image.at<uint8_t>(40, 50) = 112;
  image.at<uint8_t>(90, 90) = 112;
  const std::vector<Corner> corners = Detect(image, 20, 7);
  ASSERT_EQ(corners.size(), 2u);
  EXPECT_EQ(corners[0].score, 49);
  EXPECT_EQ(corners[1].x, 90);
  EXPECT_EQ(corners[1].score, 11);
}

TEST(CornerDetector, RespectsTheBorderAndTheRasterOrder) {
  const cv::Mat image = MakeCornerImage(101, 83);
  const std::vector<Corner> corners = Detect(image, 5, 5);
  ASSERT_GT(corners.size(), 20u);
  for (size_t i = 0; i < corners.size(); ++i) {
    const Corner& corner = corners[i];
    EXPECT_GE(corner.x, kBorder);
    EXPECT_LT(corner.x, 101 - kBorder);
    EXPECT_GE(corner.y, kBorder);
    EXPECT_LT(corner.y, 83 - kBorder);
    if (i > 0) {
      EXPECT_LT(std::tuple(corners[i - 1].y, corners[i - 1].x), std::tuple(corner.y, corner.x));
    }
  }
  cv::Mat edge(64, 64, CV_8UC1, cv::Scalar(100));
  for (const int pixel : {18, 19, 44, 45}) {
    edge.setTo(100);
    edge.at<uint8_t>(pixel, pixel) = 200;
    EXPECT_EQ(Detect(edge, 20, 20).size(), pixel == 19 || pixel == 44 ? 1u : 0u) << pixel;
  }
}

TEST(CornerDetector, FindsNothingInImagesThatAreAllBorder) {
  EXPECT_TRUE(Detect(MakeCornerImage(38, 100), 20, 7).empty());
}

TEST(CornerDetector, ReturnsTheScoresOfTheNeighbours) {
  const cv::Mat image = MakeCornerImage(200, 150);
  std::map<std::pair<int, int>, int> scores;
  for (const auto& [position, score] : OpenCvScores(image, 1)) {
    scores[position] = score;  // 0 if OpenCV suppressed it
  }
  const std::vector<Corner> corners = Detect(image, 7, 7);
  ASSERT_GT(corners.size(), 20u);
  for (const Corner& corner : corners) {
    const int highest = std::max({corner.left, corner.right, corner.above, corner.below});
    EXPECT_LE(highest, corner.score);
    // A neighbour that is a FAST corner at threshold 1 has a score of at least 1; any other
    // neighbour has 0.
    const auto is_corner = [&](int dx, int dy) {
      return scores.contains({corner.x + dx, corner.y + dy});
    };
    EXPECT_EQ(corner.left > 0, is_corner(-1, 0));
    EXPECT_EQ(corner.right > 0, is_corner(1, 0));
    EXPECT_EQ(corner.above > 0, is_corner(0, -1));
    EXPECT_EQ(corner.below > 0, is_corner(0, 1));
  }
}

TEST(SubpixelOffset, IsTheMaximumOfTheParabola) {
  // 60 - 20 (t - 1/4)^2 at t = -1, 0, 1, times 4 to give integers: 115, 235, 195.
  const Corner corner{.score = 235, .left = 115, .right = 195, .above = 195, .below = 115};
  EXPECT_FLOAT_EQ(SubpixelOffset(corner).x(), 0.25f);
  EXPECT_FLOAT_EQ(SubpixelOffset(corner).y(), -0.25f);
}

TEST(SubpixelOffset, IsAtMostHalfAPixel) {
  const Corner plateau{.score = 50, .left = 0, .right = 50, .above = 50, .below = 0};
  EXPECT_EQ(SubpixelOffset(plateau), Eigen::Vector2f(0.5f, -0.5f));
  const Corner flat{.score = 50, .left = 50, .right = 50, .above = 50, .below = 50};
  EXPECT_EQ(SubpixelOffset(flat), Eigen::Vector2f(0.0f, 0.0f));
}

// The sizes are just above twice the border; AddressSanitizer checks the reads.
TEST(CornerDetector, StaysInsideTheSmallestImages) {
  for (const int border : {8, 19}) {
    for (int extra = 1; extra < 40; extra += 3) {
      const int size = 2 * border + extra;
      cv::Mat image(size, size, CV_8UC1, cv::Scalar(100));
      image.at<uint8_t>(border, size - border - 1) = 200;
      std::vector<Corner> corners;
      CornerDetector(20, 7).Detect(image, border, corners);
      EXPECT_EQ(corners.size(), 1u) << size;
    }
  }
}

TEST(CornerDetector, RejectsInvalidArguments) {
  std::vector<Corner> corners;
  EXPECT_THROW(CornerDetector(20, 0), CheckError);
  EXPECT_THROW(CornerDetector(20, 256), CheckError);
  CornerDetector detector(20, 7);
  const cv::Mat colour(64, 64, CV_8UC3, cv::Scalar());
  EXPECT_THROW(detector.Detect(colour, kBorder, corners), CheckError);
  EXPECT_THROW(detector.Detect(MakeCornerImage(64, 64), 7, corners), CheckError);
}

constexpr int kSide = 21;
const cv::Point kCenter(kSide / 2, kSide / 2);

// An image whose grey levels are a function of the distance (px) from the centre.
template <typename Grey>
cv::Mat MakePatch(const Grey& grey) {
  cv::Mat image(kSide, kSide, CV_8UC1);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      image.at<uint8_t>(y, x) = cv::saturate_cast<uint8_t>(grey(x - kCenter.x, y - kCenter.y));
    }
  }
  return image;
}

// A border of two grey levels through the centre, 2 px wide; `angle` is that of its normal.
cv::Mat MakeEdge(double angle) {
  return MakePatch([angle](double x, double y) {
    return 130.0 + 60.0 * std::clamp(std::cos(angle) * x + std::sin(angle) * y, -1.0, 1.0);
  });
}

cv::Mat MakeCorner() {
  return MakePatch([](double x, double y) { return x >= 0.0 && y >= 0.0 ? 170.0 : 90.0; });
}

TEST(StraightEdge, IsFoundInAllDirections) {
  for (int i = 0; i < 32; ++i) {
    EXPECT_TRUE(IsStraightEdge(MakeEdge(i * std::numbers::pi / 16.0), kCenter)) << i;
  }
}

TEST(StraightEdge, CornersDotsAndPlainPatchesAreNone) {
  EXPECT_FALSE(IsStraightEdge(MakeCorner(), kCenter));
  EXPECT_FALSE(IsStraightEdge(
      MakePatch([](double x, double y) { return x * x + y * y < 5.0 ? 200.0 : 90.0; }), kCenter));
  EXPECT_FALSE(IsStraightEdge(MakePatch([](double, double) { return 90.0; }), kCenter));
}

// The tensor of |y| b + x a is diagonal. It has 49 gradients a along x, and 42 gradients b along y,
// because there is none in the middle row.
TEST(StraightEdge, IsOneIfAnEigenvalueIsSixteenTimesTheOther) {
  const auto ramp = [](double a, double b) {
    return MakePatch([a, b](double x, double y) { return 127.0 + a * x + b * std::abs(y); });
  };
  EXPECT_TRUE(IsStraightEdge(ramp(8.0, 2.0), kCenter));   // 49 64 / (42 4) = 18.7
  EXPECT_FALSE(IsStraightEdge(ramp(7.0, 2.0), kCenter));  // 49 49 / (42 4) = 14.3
}

TEST(StraightEdge, DoesNotDependOnContrastNorOnTheDirectionOfTheImage) {
  for (int i = 0; i <= 6; ++i) {
    const cv::Mat image =
        MakePatch([i](double x, double y) { return 127.0 + 6.0 * x + i * std::abs(y); });
    const bool is_edge = IsStraightEdge(image, kCenter);
    EXPECT_EQ(is_edge, IsStraightEdge(255 - image, kCenter)) << i;
    EXPECT_EQ(is_edge, IsStraightEdge(image.t(), kCenter)) << i;
    EXPECT_EQ(is_edge, i < 2) << i;  // 49 36 / (42 i^2) = 42 / i^2
  }
}

}  // namespace

}  // namespace hullslam

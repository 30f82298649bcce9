// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/texture_painter.h"

#include <gtest/gtest.h>

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

namespace hullslam::synthetic {
namespace {

using Painter = std::function<cv::Mat(uint64_t)>;

std::vector<Painter> RepeatingPainters() {
  const cv::Scalar colour(120, 140, 160);
  return {[=](uint64_t s) { return PaintPlain(s, 256, colour, 20.0); },
          [=](uint64_t s) { return PaintPlaster(s, 256, colour); },
          [=](uint64_t s) { return PaintFabric(s, 256, colour); },
          [=](uint64_t s) { return PaintSpeckle(s, 256, colour); }};
}

std::vector<Painter> AllPainters() {
  std::vector<Painter> painters = RepeatingPainters();
  painters.push_back([](uint64_t s) { return PaintBrick(s, 256); });
  painters.push_back([](uint64_t s) { return PaintWood(s, 256, cv::Scalar(90, 120, 150)); });
  painters.push_back([](uint64_t s) { return PaintChecker(s, 256, 8); });
  painters.push_back([](uint64_t s) { return PaintPoster(s, 256); });
  painters.push_back([](uint64_t s) { return PaintPage(s, 256); });
  painters.push_back([](uint64_t s) { return PaintKeys(s, 256); });
  painters.push_back([](uint64_t s) { return PaintScreen(s, 256); });
  return painters;
}

TEST(TexturePainter, ThePictureDependsOnTheSeedOnly) {
  for (const Painter& paint : AllPainters()) {
    const cv::Mat first = paint(1);
    ASSERT_EQ(first.type(), CV_8UC3);
    ASSERT_EQ(first.size(), cv::Size(256, 256));
    EXPECT_EQ(cv::norm(first, paint(1), cv::NORM_INF), 0.0);
    EXPECT_GT(cv::norm(first, paint(2), cv::NORM_INF), 0.0);
  }
}

// Mean absolute difference between two columns, in grey levels.
double Difference(const cv::Mat& image, int a, int b) {
  return cv::norm(image.col(a), image.col(b), cv::NORM_L1) / (3.0 * image.rows);
}

TEST(TexturePainter, RepeatsWithoutASeam) {
  for (const Painter& paint : RepeatingPainters()) {
    const cv::Mat image = paint(3);
    double inside = 0.0;
    for (int x = 0; x + 1 < image.cols; ++x) {
      inside += Difference(image, x, x + 1) / (image.cols - 1);
    }
    EXPECT_LT(Difference(image, image.cols - 1, 0), 2.0 * inside);
  }
}

TEST(TexturePainter, NoiseHasZeroMeanAndStaysSmall) {
  const cv::Mat noise = PaintNoise(9, 512, 8, 5);
  double low = 0.0;
  double high = 0.0;
  cv::minMaxLoc(noise, &low, &high);
  EXPECT_NEAR(cv::mean(noise)[0], 0.0, 0.1);
  EXPECT_GT(high - low, 0.8);
  EXPECT_GT(low, -1.6);
  EXPECT_LT(high, 1.6);
}

}  // namespace
}  // namespace hullslam::synthetic

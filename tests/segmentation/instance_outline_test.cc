// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/instance_outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace hullslam {
namespace {

// The prototype of a disc: at a quarter of the resolution, the logit is its signed distance.
cv::Mat DiscPrototype(const Letterbox& letterbox, const Eigen::Vector2d& centre, double radius) {
  const std::array<int, 4> shape = {1, 1, letterbox.input.height / 4, letterbox.input.width / 4};
  cv::Mat prototypes(4, shape.data(), CV_32F);
  for (int y = 0; y < shape[2]; ++y) {
    for (int x = 0; x < shape[3]; ++x) {
      const Eigen::Array2d point = letterbox.ToImage({4.0 * (x + 0.5), 4.0 * (y + 0.5)}) - 0.5;
      prototypes.ptr<float>(0, 0, y)[x] =
          static_cast<float>(radius - (point.matrix() - centre).norm());
    }
  }
  return prototypes;
}

Candidate WholeInput(const Letterbox& letterbox) {
  return {.least = {0.0, 0.0},
          .greatest = {static_cast<double>(letterbox.input.width),
                       static_cast<double>(letterbox.input.height)},
          .score = 1.0,
          .class_number = 0,
          .coefficients = Eigen::VectorXf::Ones(1)};
}

// A mask that is decided at a quarter of the resolution errs by two pixels and more.
TEST(InstanceOutline, ErrsByLessThanAPixelThoughThePrototypesAreCoarse) {
  for (const cv::Size image : {cv::Size(160, 96), cv::Size(200, 120), cv::Size(101, 77)}) {
    const Letterbox letterbox = FitLetterbox(image, {160, 96});
    const Eigen::Vector2d centre(0.5 * image.width + 1.3, 0.5 * image.height - 2.2);
    const double radius = 0.3 * image.height;
    const auto outline = FindInstanceOutline(WholeInput(letterbox),
                                             DiscPrototype(letterbox, centre, radius), letterbox);
    ASSERT_GE(outline.size(), 20U);
    for (const Eigen::Vector2d& point : outline) {
      EXPECT_NEAR((point - centre).norm(), radius, 1.0);
    }
  }
}

TEST(InstanceOutline, IsCutAtTheBoxAndAtTheImage) {
  const Letterbox letterbox = FitLetterbox({160, 96}, {160, 96});
  Candidate candidate = WholeInput(letterbox);
  candidate.least.x() = 60.0;
  const auto outline =
      FindInstanceOutline(candidate, DiscPrototype(letterbox, {60.0, 90.0}, 30.0), letterbox);
  ASSERT_FALSE(outline.empty());
  for (const Eigen::Vector2d& point : outline) {
    EXPECT_GE(point.x(), 59.5);
    EXPECT_LE(point.y(), 95.5);
  }
  candidate.greatest = candidate.least;
  EXPECT_TRUE(
      FindInstanceOutline(candidate, DiscPrototype(letterbox, {60.0, 90.0}, 30.0), letterbox)
          .empty());
}

}  // namespace
}  // namespace hullslam

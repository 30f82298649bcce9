// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/depth_registration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// Textured boxes, 1 m away, before a textured wall, 2 m away.
struct Scene {
  explicit Scene(int seed) : grey(480, 640, CV_8UC1), depth(480, 640, CV_16UC1, cv::Scalar(2000)) {
    cv::RNG random(static_cast<uint64_t>(seed));
    random.fill(grey, cv::RNG::NORMAL, 90, 12);
    for (int i = 0; i < 12; ++i) {
      const cv::Rect box(random.uniform(40, 500), random.uniform(40, 380), 70, 50);
      cv::Mat inside = grey(box);
      random.fill(inside, cv::RNG::NORMAL, 150, 12);
      depth(box).setTo(1000);
    }
  }

  // Moves and scales the depth image against the colour image.
  cv::Mat Moved(double scale, double x, double y) const {
    const cv::Matx23d motion(scale, 0, 320 * (1 - scale) + x, 0, scale, 240 * (1 - scale) + y);
    cv::Mat moved;
    cv::warpAffine(depth, moved, motion, depth.size(), cv::INTER_NEAREST);
    return moved;
  }

  cv::Mat grey;
  cv::Mat depth;
};

double ContrastOf(double scale, double x, double y) {
  DepthRegistration registration;
  for (int seed = 1; seed <= 4; ++seed) {
    const Scene scene(seed);
    registration.Add(scene.grey, scene.Moved(scale, x, y));
  }
  EXPECT_GT(registration.edges(), 2000u);
  return registration.Contrast();
}

TEST(DepthRegistration, RegisteredDepthChangesWhereTheColourDoes) {
  EXPECT_GT(ContrastOf(1.0, 0.0, 0.0), 1.5);
  EXPECT_GT(ContrastOf(1.0, 1.0, -1.0), 1.4) << "depth sensors are off by a pixel";
}

TEST(DepthRegistration, MovedOrScaledDepthDoesNot) {
  EXPECT_LT(ContrastOf(1.0, 14.0, 6.0), 1.15);
  EXPECT_LT(ContrastOf(1.0, -18.0, 14.0), 1.15);
  EXPECT_LT(ContrastOf(580.0 / 525.0, 12.0, 0.0), 1.3) << "the depth camera of a Kinect";
}

TEST(DepthRegistration, MovedDepthFitsElsewhere) {
  const auto share = [](double x, double y) {
    DepthRegistration registration;
    for (int seed = 1; seed <= 4; ++seed) {
      const Scene scene(seed);
      registration.Add(scene.grey, scene.Moved(1.0, x, y));
    }
    return (registration.Contrast() - 1.0) / (registration.ContrastElsewhere() - 1.0);
  };
  EXPECT_GT(share(0.0, 0.0), 1.0);
  EXPECT_LT(share(20.0, 0.0), 0.5);
  EXPECT_LT(share(-24.0, 9.0), 0.5);
}

// Stripes that cross the border of a box are no borders of it.
TEST(DepthRegistration, EdgesInOtherDirectionsDoNotCount) {
  DepthRegistration registration;
  cv::Mat grey(480, 640, CV_8UC1);
  for (int y = 0; y < grey.rows; ++y) {
    grey.row(y).setTo(y % 8 < 4 ? 60 : 180);
  }
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(2000));
  depth(cv::Rect(300, 0, 40, 480)).setTo(1000);  // borders to the left and to the right only
  registration.Add(grey, depth);
  EXPECT_GT(registration.edges(), 1000u);
  EXPECT_EQ(registration.Contrast(), 1.0);
}

TEST(DepthRegistration, TheUnitAndUnknownDepthDoNotMatter) {
  const Scene scene(1);
  DepthRegistration units;
  units.Add(scene.grey, scene.depth);
  cv::Mat metres;
  scene.depth.convertTo(metres, CV_32F, 0.001);
  DepthRegistration as_metres;
  as_metres.Add(scene.grey, metres);
  EXPECT_EQ(as_metres.edges(), units.edges());
  EXPECT_NEAR(as_metres.Contrast(), units.Contrast(), 1e-6);
  metres.rowRange(0, 200).setTo(std::nanf(""));
  DepthRegistration with_holes;
  with_holes.Add(scene.grey, metres);
  EXPECT_GT(with_holes.edges(), 0u);
  EXPECT_LT(with_holes.edges(), units.edges());
}

// The bounds of the contrast hold for images of any size, with depth images of any other size.
TEST(DepthRegistration, TheSizeOfTheImagesDoesNotMatter) {
  const auto contrast_of = [](double enlarged, double depth_share) {
    DepthRegistration registration;
    for (int seed = 1; seed <= 4; ++seed) {
      const Scene scene(seed);
      cv::Mat grey;
      cv::Mat depth;
      cv::resize(scene.grey, grey, {}, enlarged, enlarged, cv::INTER_CUBIC);
      cv::resize(scene.depth, depth, {}, depth_share, depth_share, cv::INTER_NEAREST);
      registration.Add(grey, depth);
    }
    return registration.Contrast();
  };
  const double usual = contrast_of(1.0, 1.0);
  EXPECT_GT(contrast_of(3.0, 3.0), 0.9 * usual);
  EXPECT_GT(contrast_of(3.0, 0.4), 0.9 * usual);
  EXPECT_GT(contrast_of(1.0, 0.4), 0.9 * usual);
}

TEST(DepthRegistration, AWallHasNoSteps) {
  DepthRegistration registration;
  const cv::Mat grey(480, 640, CV_8UC1, cv::Scalar(90));
  registration.Add(grey, cv::Mat(480, 640, CV_16UC1, cv::Scalar(2000)));
  registration.Add(grey, cv::Mat(480, 640, CV_16UC1, cv::Scalar(0)));
  EXPECT_EQ(registration.edges(), 0u);
  EXPECT_THROW(registration.Contrast(), CheckError);
}

// The steps of the depth at a box before a wall: the three or two rows and columns along its
// border.
size_t StepsOf(double near, double far) {
  cv::Mat depth(480, 640, CV_32FC1, cv::Scalar(far));
  depth(cv::Rect(300, 200, 40, 20)).setTo(near);
  DepthRegistration registration;
  registration.Add(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)), depth);
  if (registration.edges() > 0) {
    EXPECT_EQ(registration.Contrast(), 1.0) << "an image without edges tells nothing";
  }
  return registration.edges();
}

TEST(DepthRegistration, AStepIsATenthAndOnItsNearSide) {
  EXPECT_EQ(StepsOf(1.0, 1.09), 0u);
  EXPECT_EQ(StepsOf(1.0, 1.11), 40u * 20u - 36u * 16u) << "two pixels inside the box";
}

// Along a slope, something nearer is as near as what is farther.
TEST(DepthRegistration, ASlopeIsNoStep) {
  cv::Mat depth(480, 640, CV_32FC1);
  for (int x = 0; x < depth.cols; ++x) {
    depth.col(x).setTo(0.5 * std::pow(1.06, x % 100));
  }
  depth = depth.colRange(200, 300).clone();
  DepthRegistration registration;
  registration.Add(cv::Mat(depth.size(), CV_8UC1, cv::Scalar(90)), depth);
  EXPECT_EQ(registration.edges(), 0u);
}

}  // namespace
}  // namespace hullslam

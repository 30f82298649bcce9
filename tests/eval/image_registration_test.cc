// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/image_registration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// Two vertical edges of the given heights, far from each other and from the borders.
cv::Mat TwoEdges(int first, int second) {
  cv::Mat grey(40, 60, CV_8UC1, cv::Scalar(0));
  grey.colRange(20, 60).setTo(first);
  grey.colRange(40, 60).setTo(first + second);
  return grey;
}

TEST(RelativeGradient, HasTheMeanOne) {
  const cv::Mat gradient = RelativeGradient(TwoEdges(10, 30));
  EXPECT_EQ(gradient.type(), CV_32FC1);
  EXPECT_NEAR(cv::mean(gradient)[0], 1.0, 1e-5);
  EXPECT_NEAR(gradient.at<float>(20, 40), 3.0f * gradient.at<float>(20, 20), 1e-4f);
  EXPECT_EQ(gradient.at<float>(20, 10), 0.0f);
  cv::Mat turned = RelativeGradient(TwoEdges(10, 30).t());
  EXPECT_LT(cv::norm(turned.t(), gradient, cv::NORM_INF), 1e-5) << "both directions count";
}

// Sobel's filter multiplies the height of an edge by 4, so those above 50 are limited.
TEST(RelativeGradient, StrongEdgesAreLimited) {
  const cv::Mat gradient = RelativeGradient(TwoEdges(60, 180));
  EXPECT_FLOAT_EQ(gradient.at<float>(20, 20), gradient.at<float>(20, 40));
  const cv::Mat below = RelativeGradient(TwoEdges(40, 180));
  EXPECT_NEAR(below.at<float>(20, 40), 1.25f * below.at<float>(20, 20), 1e-4f);
}

TEST(RelativeGradient, IsZeroWithoutEdges) {
  EXPECT_EQ(cv::countNonZero(RelativeGradient(cv::Mat(9, 9, CV_8UC1, cv::Scalar(7)))), 0);
}

// A bright rectangle on noise, away from all axes of symmetry.
constexpr int kX = 20, kY = 10, kWidth = 50, kHeight = 30;

cv::Mat MadeImage() {
  cv::Mat image(120, 160, CV_8UC1);
  cv::theRNG().state = 5;
  cv::randu(image, 0, 20);
  image(cv::Rect(kX, kY, kWidth, kHeight)) += 150;
  return image;
}

// The mask of the rectangle in the image that is turned: `turn` is done to a picture of it.
InstanceMask MadeMask(int orientation) {
  cv::Mat mask = cv::Mat::zeros(120, 160, CV_8UC1);
  mask(cv::Rect(kX, kY, kWidth, kHeight)).setTo(255);
  if (orientation == 6) {
    cv::rotate(mask, mask, cv::ROTATE_90_CLOCKWISE);
  } else if (orientation == 8) {
    cv::rotate(mask, mask, cv::ROTATE_90_COUNTERCLOCKWISE);
  } else if (orientation == 3) {
    cv::rotate(mask, mask, cv::ROTATE_180);
  } else if (orientation == 2) {
    cv::flip(mask, mask, 1);
  } else if (orientation == 4) {
    cv::flip(mask, mask, 0);
  } else if (orientation == 5) {
    mask = mask.t();
  } else if (orientation == 7) {
    cv::rotate(cv::Mat(mask.t()), mask, cv::ROTATE_180);
  }
  const cv::Rect box = cv::boundingRect(mask);
  // Formats with shares of the size are scaled to the size of the camera.
  const Eigen::Vector2d scale(160.0 / mask.cols, 120.0 / mask.rows);
  InstanceMask made;
  made.outlines.emplace_back();
  for (const auto& [x, y] : {std::pair(box.x, box.y), std::pair(box.br().x, box.y),
                             std::pair(box.br().x, box.br().y), std::pair(box.x, box.br().y)}) {
    made.outlines.front().emplace_back(x * scale.x() - 0.5, y * scale.y() - 0.5);
  }
  return made;
}

TEST(MaskRegistrationTest, TheOrientationOfTheMasksHasTheHighestContrast) {
  const cv::Mat image = MadeImage();
  for (int truth = 1; truth <= 8; ++truth) {
    MaskRegistration registration;
    const std::vector<InstanceMask> masks = {MadeMask(truth)};
    registration.Add(image, masks);
    EXPECT_GT(registration.points(), 130U);
    for (int orientation = 1; orientation <= 8; ++orientation) {
      if (orientation == truth) {
        EXPECT_GT(registration.Contrast(orientation), 3.0) << truth;
      } else {
        EXPECT_LT(registration.Contrast(orientation), 2.0) << truth << ' ' << orientation;
      }
    }
  }
}

TEST(MaskRegistrationTest, OnlyContoursCount) {
  InstanceMask box = MadeMask(1);
  box.shape = MaskShape::kBox;
  MaskRegistration registration;
  registration.Add(MadeImage(), std::vector<InstanceMask>{box, InstanceMask{}});
  EXPECT_EQ(registration.points(), 0U);
  EXPECT_THROW(registration.Contrast(1), CheckError);
}

TEST(MaskRegistrationTest, EachContourCountsWithItsLength) {
  MaskRegistration registration;
  std::vector<InstanceMask> masks = {MadeMask(1), MadeMask(1)};
  masks[1].outlines.push_back(masks[1].outlines.front());  // only the first is the outer border
  registration.Add(MadeImage(), masks);
  EXPECT_EQ(registration.points(), 2U * 2U * (kWidth + kHeight));
  EXPECT_THROW(registration.Contrast(0), CheckError);
  EXPECT_THROW(registration.Contrast(9), CheckError);
}

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

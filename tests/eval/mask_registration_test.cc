// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/mask_registration.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

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

}  // namespace
}  // namespace hullslam

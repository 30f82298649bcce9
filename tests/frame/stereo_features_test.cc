// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/stereo_features.h"

#include <gtest/gtest.h>

#include <cmath>

#include "features/test_images.h"

namespace hullslam {
namespace {

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

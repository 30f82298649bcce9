// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/stereo_features.h"

#include <gtest/gtest.h>

#include <cmath>

#include "features/test_images.h"

namespace hullslam {
namespace {

TEST(StereoFeatures, DepthsFollowFromBaselineAndDisparity) {
  const PinholeCamera camera{.fx = 500.0, .fy = 500.0, .cx = 319.5, .cy = 239.5, .bf = 60.0};
  const cv::Mat left = MakeCornerImage();
  const int disparity = 30;
  cv::Mat right(left.size(), CV_8UC1, cv::Scalar(120));
  left.colRange(disparity, left.cols).copyTo(right.colRange(0, left.cols - disparity));
  FeatureExtractor extractor{FeatureOptions()};
  const ExtractedFeatures features = extractor.Extract(left);
  StereoFeatures stereo(FeatureOptions(), camera);
  SerialRunner runner;
  const std::vector<float> depths = stereo.FindDepths(features, extractor.pyramid(), right, runner);
  ASSERT_EQ(depths.size(), features.keypoints.size());
  size_t known = 0;
  size_t exact = 0;
  for (const float depth : depths) {
    known += depth > 0.0F ? 1 : 0;
    exact += std::abs(depth - 2.0F) < 0.1F ? 1 : 0;  // 1.5 px of 30, half a pixel at upper levels
  }
  EXPECT_GT(known, depths.size() * 4 / 10) << "the others have no keypoint in the right image";
  EXPECT_GT(exact, known * 9 / 10);
}

}  // namespace
}  // namespace hullslam

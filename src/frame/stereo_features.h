// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "features/extractor.h"
#include "frame/stereo_matcher.h"
#include "hullslam/camera/pinhole.h"
#include "util/task_runner.h"

namespace hullslam {

// Finds the keypoints of a left image in the right one. Keeps its buffers from pair to pair.
class StereoFeatures {
 public:
  // `camera` is that of the rectified images. Points nearer than the baseline are not found.
  StereoFeatures(const FeatureOptions& features, const PinholeCamera& camera);

  // Extracts the features of the left image with its extractor, and beside them those of the right
  // one (CV_8UC1), which has the size of the left one. `ignored` are the pixels of both where no
  // features are wanted, as in FeatureExtractor.
  ExtractedFeatures Extract(FeatureExtractor& left_extractor, const cv::Mat& left,
                            const cv::Mat& right, TaskRunner& runner,
                            const std::array<cv::Mat, 2>& ignored = {});
  // The disparities of keypoints of the left image of the last call of Extract, one each, px; 0
  // where none was found. Other keypoints may have been taken out.
  std::vector<float> FindDisparities(const ExtractedFeatures& left,
                                     const ImagePyramid& left_pyramid, TaskRunner& runner);
  // The features of the right image of the last call of Extract.
  const ExtractedFeatures& right() const { return right_; }

 private:
  FeatureExtractor extractor_;
  StereoMatcher matcher_;
  ExtractedFeatures right_;
};

}  // namespace hullslam

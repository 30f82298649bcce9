// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "features/extractor.h"
#include "frame/stereo_matcher.h"
#include "hullslam/camera/pinhole.h"
#include "util/task_runner.h"

namespace hullslam {

// Finds the depths of the keypoints of a left image in the right one. Keeps its buffers from pair
// to pair.
class StereoFeatures {
 public:
  // `camera` is that of the rectified images. Points nearer than the baseline are not found.
  StereoFeatures(const FeatureOptions& features, const PinholeCamera& camera);

  // One depth per left keypoint, m; 0 where it is unknown. `right` (CV_8UC1) has the size of the
  // left image.
  std::vector<float> FindDepths(const ExtractedFeatures& left, const ImagePyramid& left_pyramid,
                                const cv::Mat& right, TaskRunner& runner);

 private:
  FeatureExtractor extractor_;
  StereoMatcher matcher_;
  double bf_;
};

}  // namespace hullslam

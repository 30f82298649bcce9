// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "features/extractor.h"
#include "features/pyramid.h"
#include "hullslam/camera/pinhole.h"
#include "util/task_runner.h"

namespace hullslam {

// The features of one image of a pair, with the pyramid that they are from.
struct StereoImage {
  const ExtractedFeatures& features;
  const ImagePyramid& pyramid;
};

// Finds the columns of keypoints in the right image of a rectified pair, as ORB-SLAM2 does
// (Mur-Artal and Tardos 2017, section III.A): the right keypoint with the most similar descriptor
// in the same rows, at the same or a neighbouring level, to the left by at most `largest_disparity`
// (px); then the column where the patch of the left keypoint fits best, to a fraction of a pixel
// (patch_fit.h). Matches whose difference is much larger than the median of the pair are left out.
class StereoMatcher {
 public:
  StereoMatcher(const ScaleLevels& levels, double largest_disparity);

  // One disparity per left keypoint, px at level 0, > 0; 0 where none was found.
  std::vector<float> Match(const StereoImage& left, const StereoImage& right, TaskRunner& runner);

 private:
  struct Found {
    float disparity = 0.0F;
    float difference = 0.0F;  // mean absolute difference of the patches, grey levels
  };
  void SortIntoRows(const StereoImage& right);
  Found MatchOne(const StereoImage& left, const StereoImage& right, size_t keypoint) const;

  std::vector<float> scale_;
  float largest_disparity_;
  std::vector<std::vector<uint32_t>> rows_;  // the right keypoints that may lie in each row
};

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

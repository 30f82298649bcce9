// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "features/pyramid.h"
#include "hullslam/features/feature_options.h"
#include "hullslam/features/feature_set.h"
#include "util/task_runner.h"

namespace hullslam {

struct ExtractedFeatures {
  std::vector<RawKeypoint> keypoints;   // ordered by level
  std::vector<Descriptor> descriptors;  // one per keypoint
};

// Whether a mask of pixels that are ignored, which may be empty, has a raw position.
bool IsIgnored(const cv::Mat& ignored, const Eigen::Vector2f& raw);

// Extracts ORB features from images. It keeps its buffers from image to image, so use one extractor
// per thread.
class FeatureExtractor {
 public:
  // If `halves_levels`, only every other level of the pyramid has features, and those of two: a
  // keypoint of any level is then found on its own level or on a neighbouring one, in less time.
  explicit FeatureExtractor(const FeatureOptions& options, bool halves_levels = false);
  ~FeatureExtractor();
  FeatureExtractor(FeatureExtractor&&) noexcept;
  FeatureExtractor& operator=(FeatureExtractor&&) noexcept;

  const ScaleLevels& levels() const;
  // The pyramid of the last image, which must still be alive.
  const ImagePyramid& pyramid() const;

  // Throws CheckError unless `grey` is CV_8UC1 and at least 64 x 64 px. Returns about feature_count
  // features, or fewer if the image has fewer corners.
  ExtractedFeatures Extract(const cv::Mat& grey);
  // The same features, with one task per level of the pyramid. `ignored` is empty, or CV_8UC1 of
  // the size of the image: where it is not 0, no features are wanted, and there are as many more
  // elsewhere.
  ExtractedFeatures Extract(const cv::Mat& grey, TaskRunner& runner, const cv::Mat& ignored = {});
  // What Extract() gives for the image of each of two extractors, with all their tasks together, so
  // that two threads are busy with both images until the end.
  static std::array<ExtractedFeatures, 2> ExtractPair(
      const std::array<FeatureExtractor*, 2>& extractors, const std::array<cv::Mat, 2>& images,
      TaskRunner& runner, const std::array<cv::Mat, 2>& ignored = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hullslam

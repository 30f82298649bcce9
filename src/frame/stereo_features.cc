// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/stereo_features.h"

#include <utility>

namespace hullslam {

StereoFeatures::StereoFeatures(const FeatureOptions& features, const PinholeCamera& camera)
    : extractor_(features), matcher_(extractor_.levels(), camera.fx) {}

ExtractedFeatures StereoFeatures::Extract(FeatureExtractor& left_extractor, const cv::Mat& left,
                                          const cv::Mat& right, TaskRunner& runner,
                                          const std::array<cv::Mat, 2>& ignored) {
  std::array<ExtractedFeatures, 2> both =
      FeatureExtractor::ExtractPair({&left_extractor, &extractor_}, {left, right}, runner, ignored);
  right_ = std::move(both[1]);
  return std::move(both[0]);
}

std::vector<float> StereoFeatures::FindDisparities(const ExtractedFeatures& left,
                                                   const ImagePyramid& left_pyramid,
                                                   TaskRunner& runner) {
  return matcher_.Match({left, left_pyramid}, {right_, extractor_.pyramid()}, runner);
}

}  // namespace hullslam

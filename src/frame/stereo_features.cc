// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/stereo_features.h"

namespace hullslam {

StereoFeatures::StereoFeatures(const FeatureOptions& features, const PinholeCamera& camera)
    : extractor_(features), matcher_(extractor_.levels(), camera.fx), bf_(camera.bf) {}

std::vector<float> StereoFeatures::FindDepths(const ExtractedFeatures& left,
                                              const ImagePyramid& left_pyramid,
                                              const cv::Mat& right, TaskRunner& runner) {
  const ExtractedFeatures others = extractor_.Extract(right, runner);
  std::vector<float> depths =
      matcher_.Match({left, left_pyramid}, {others, extractor_.pyramid()}, runner);
  for (float& depth : depths) {
    depth = depth > 0.0F ? static_cast<float>(bf_ / static_cast<double>(depth)) : 0.0F;
  }
  return depths;
}

}  // namespace hullslam

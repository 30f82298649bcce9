// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/pyramid.h"

#include <opencv2/core.hpp>

#include "hullslam/util/check.h"

namespace hullslam {

ImagePyramid::ImagePyramid(const ScaleLevels& levels)
    : scale_(levels.scale), images_(levels.scale.size()), shrinkers_(levels.scale.size()) {}

void ImagePyramid::Build(const cv::Mat& grey) {
  Check(grey.type() == CV_8UC1, "the image is not CV_8UC1");
  images_[0] = grey;
  for (size_t l = 1; l < images_.size(); ++l) {
    const cv::Size size(cvRound(grey.cols / scale_[l]), cvRound(grey.rows / scale_[l]));
    Check(size.width > 0 && size.height > 0, "the image is too small for the pyramid");
    shrinkers_[l].Shrink(images_[l - 1], size, images_[l]);
  }
}

Eigen::Array2f ImagePyramid::Ratio(int l) const {
  const cv::Mat& image = level(l);
  return {static_cast<float>(images_[0].cols) / static_cast<float>(image.cols),
          static_cast<float>(images_[0].rows) / static_cast<float>(image.rows)};
}

Eigen::Vector2f ImagePyramid::ToLevelZero(const Eigen::Vector2f& pixel, int l) const {
  return (pixel.array() + 0.5f) * Ratio(l) - 0.5f;
}

Eigen::Vector2f ImagePyramid::FromLevelZero(const Eigen::Vector2f& pixel, int l) const {
  return (pixel.array() + 0.5f) / Ratio(l) - 0.5f;
}

}  // namespace hullslam

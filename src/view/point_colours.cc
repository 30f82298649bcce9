// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/point_colours.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace hullslam {
namespace {

// The mean of 3 x 3 px, red first. A landmark is a corner, so its own pixel alone is noise.
Eigen::Vector3d MeanAround(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  const cv::Point center(std::clamp(static_cast<int>(std::lround(pixel.x())), 0, image.cols - 1),
                         std::clamp(static_cast<int>(std::lround(pixel.y())), 0, image.rows - 1));
  const cv::Rect around =
      cv::Rect(center - cv::Point(1, 1), cv::Size(3, 3)) & cv::Rect({}, image.size());
  const cv::Scalar mean = cv::mean(image(around));
  return {mean[2], mean[1], mean[0]};
}

}  // namespace

PointColours::PointColours(const Map& map, std::span<const LandmarkId> landmarks)
    : map_(&map), sums_(landmarks.size()) {
  for (size_t i = 0; i < landmarks.size(); ++i) {
    index_[landmarks[i]] = i;
  }
}

void PointColours::Add(KeyframeId keyframe, const cv::Mat& image, const PinholeCamera& camera) {
  const Keyframe& observer = map_->keyframes().At(keyframe);
  for (size_t i = 0; i < observer.landmarks.size(); ++i) {
    const auto found = index_.find(observer.landmarks[i]);
    if (found != index_.end()) {
      const Eigen::Vector2f& undistorted = observer.frame->features.keypoints[i].undistorted;
      Sum& sum = sums_[found->second];
      sum.red_green_blue += MeanAround(image, camera.Distort(undistorted.cast<double>()));
      ++sum.images;
    }
  }
}

std::vector<Colour> PointColours::Colours() const {
  std::vector<Colour> colours;
  for (const Sum& sum : sums_) {
    Colour colour = {128, 128, 128};
    for (size_t channel = 0; sum.images > 0 && channel < 3; ++channel) {
      colour[channel] = static_cast<uint8_t>(
          std::lround(sum.red_green_blue[static_cast<Eigen::Index>(channel)] / sum.images));
    }
    colours.push_back(colour);
  }
  return colours;
}

}  // namespace hullslam

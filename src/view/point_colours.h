// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/map/map.h"
#include "results/unit_mesh.h"

namespace hullslam {

// The colours of landmarks: means over the images of the keyframes that observe them.
class PointColours {
 public:
  // The map must outlive the object.
  PointColours(const Map& map, std::span<const LandmarkId> landmarks);

  // Adds the image of a keyframe: CV_8UC3 with blue first, in raw pixels of the camera.
  void Add(KeyframeId keyframe, const cv::Mat& image, const PinholeCamera& camera);
  // One colour per landmark, in the order of the constructor; grey if no image was added that shows
  // the landmark.
  std::vector<Colour> Colours() const;

 private:
  struct Sum {
    Eigen::Vector3d red_green_blue = Eigen::Vector3d::Zero();
    int images = 0;
  };
  const Map* map_;
  std::unordered_map<LandmarkId, size_t> index_;  // of the sum of a landmark
  std::vector<Sum> sums_;
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// The pixels of a mask inside the raw image.
class MaskRegion {
 public:
  MaskRegion(std::span<const std::vector<Eigen::Vector2d>> outlines, const PinholeCamera& camera);

  bool Contains(const Eigen::Vector2d& raw) const {
    const int x = cvRound(raw.x()) - box_.x;
    const int y = cvRound(raw.y()) - box_.y;
    return x >= 0 && y >= 0 && x < box_.width && y < box_.height &&
           pixels_.at<unsigned char>(y, x) != 0;
  }
  // Whether this pixel and the pixels at a distance of `margin` px in eight directions are in the
  // mask.
  bool ContainsAround(const Eigen::Vector2d& raw, double margin) const;

  int area() const { return area_; }  // px
  const cv::Rect& box() const { return box_; }
  friend int SharedArea(const MaskRegion& a, const MaskRegion& b);  // px

 private:
  cv::Rect box_;
  cv::Mat pixels_;  // CV_8UC1, of the size of the box
  int area_ = 0;
};

// A mask (CV_8UC1) that is 255 at the pixels of the raw image that show things of these classes,
// and in a small margin around them. Empty if there are no such things.
cv::Mat DynamicMask(std::span<const InstanceMask> masks, const std::set<std::string>& classes,
                    cv::Size size);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// The keys with which ORB-SLAM3 resizes images: Camera.newWidth and Camera.newHeight, px, or
// Camera.imageScale. The other settings describe the images as read.
class ResizeSettings {
 public:
  // Whether the key is one of these. If so, its value is kept. Throws InputError, which begins with
  // `origin`, for a value that is out of range.
  bool Take(const std::string& key, const std::string& text, const std::string& origin);

  // Whether images of this size are resized at all. Throws like Resized().
  bool Changes(const PinholeCamera& camera) const;
  // The camera of the resized images. A pixel covers its whole square: the pixel x becomes
  // (x + 1/2) s - 1/2, as in cv::resize(). Throws InputError if both a scale and a size are given.
  PinholeCamera Resized(const PinholeCamera& camera) const;

 private:
  std::optional<int> width_;
  std::optional<int> height_;
  std::optional<double> scale_;
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hullslam::synthetic {

// A repeating colour image with its mip levels (Williams 1983). Samples are band-limited: detail
// that is smaller than a pixel is averaged, so that corners do not flicker from frame to frame.
class Texture {
 public:
  // Throws CheckError unless `image` is CV_8UC3 (BGR), square, and a power of two wide.
  explicit Texture(const cv::Mat& image);

  int size() const { return levels_.front().size; }
  // The mip level, with a fraction, for samples that represent a width of `footprint` image widths.
  float LevelOfDetail(float footprint) const;
  // The colour (BGR, 0 to 255) at (u, v). 1 is one image width or height, and v points down.
  Eigen::Vector3f Sample(const Eigen::Vector2f& uv, float level_of_detail) const;

 private:
  struct Level {
    int size = 0;
    std::vector<uint64_t> texels;  // B, G and R in the lower three 16-bit lanes
  };
  std::vector<Level> levels_;
};

}  // namespace hullslam::synthetic

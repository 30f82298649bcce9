// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// Whether a depth image can be that of a colour image of another size: their ratios of width to
// height agree to 1 %. ScanNet has 640x480 beside 1296x968 px, which differ by 0.4 %.
bool HaveSameShape(const cv::Size& depth, const cv::Size& colour);

// The depth image (CV_16UC1 or CV_32FC1) at another size, as if each of its pixels covered a part
// of the colour image. Between four pixels of one surface the inverse depth is interpolated, which
// is exact on planes. Where the four are not of one surface, or not all known, it is that of the
// nearest pixel, so foreground and background are never mixed. An image of this size is returned as
// it is.
cv::Mat FitDepth(const cv::Mat& depth, const cv::Size& size);

// The depth image with the true disparities bf / z, if all of it are too large by `offset` (px).
// Depths whose true disparity is not positive become unknown. `bf` is in m px. The image itself if
// the offset is 0.
cv::Mat WithoutDisparityOffset(const cv::Mat& depth, double offset, double bf,
                               double units_per_metre);

// Registers depth images to a colour camera that sees things from elsewhere. A pixel p of the
// colour image at the ray r (z = 1) sees a point at the inverse depth q at
//   Distort(Project(R r + q t))   with depth_from_colour = (R, t),
// in the depth image, which is p + a + q b to first order in q, with a and b from tables. With the
// depth there, z, at whose pixel the ray is r', the depth of the point is (R^T (z r' - t))_z.
class DepthReprojection {
 public:
  // `depth_from_colour`: a rotation vector (rad) and a translation (m), small.
  DepthReprojection(const PinholeCamera& camera, const std::array<double, 6>& depth_from_colour);

  // A depth image (CV_16UC1 or CV_32FC1) of the size of the camera's images. A depth is unknown
  // where it is unknown at the same pixel, or where the point would be seen, in the given one.
  cv::Mat Register(const cv::Mat& depth, double units_per_metre) const;

 private:
  struct Pixel {
    Eigen::Vector2f at_infinity;  // a, px
    Eigen::Vector2f by_inverse;   // b, px m
    float depth_factor = 1.0F;    // of z at this pixel of the depth image
  };

  template <typename Value>
  void Fill(const cv::Mat& depth, float units, cv::Mat& registered) const;

  cv::Size size_;
  std::vector<Pixel> pixels_;  // row by row
  float depth_shift_ = 0.0F;   // m, added to depths
};

}  // namespace hullslam

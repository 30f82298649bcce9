// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/camera/depth.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "hullslam/util/check.h"

namespace hullslam {

DepthErrorOptions DepthErrorOptions::ForAdjustment() const {
  DepthErrorOptions options = *this;
  options.pixel_sigma = adjustment_pixel_sigma;
  return options;
}

void DepthErrorOptions::Bind(OptionTable& options) {
  const OptionScope scope(options, "depth");
  scope.Add("pixel_sigma", &pixel_sigma, Range::Between(0.01, 100.0),
            "error of a keypoint of pyramid level 0 in tracking and mapping, px");
  scope.Add("adjustment_pixel_sigma", &adjustment_pixel_sigma, Range::Between(0.01, 100.0),
            "error of a keypoint of pyramid level 0 in bundle adjustment, px");
  scope.Add("disparity_sigma", &disparity_sigma, Range::Between(0.01, 100.0),
            "error of a depth, as an error of the disparity Camera.bf / depth, px");
  scope.AddEnum("model", &model, {"disparity", "right_column"},
                "error of a keypoint with depth: pixel and disparity have independent errors, or "
                "both columns of a stereo camera have the error of the keypoint");
  scope.AddEnum("adjustment_rule", &adjustment_rule, {"hullslam", "orb_slam2"},
                "weights and loss of keypoints without depth in bundle adjustment: measured "
                "precision and Cauchy's loss, or fixed sigmas and Huber's loss");
}

void DepthOptions::Bind(OptionTable& options) {
  // With less, the largest value of a depth image, 65535, is beyond the largest distance of the
  // files, 1e8 m; with more, it is nearer than any camera sees.
  options.Add("DepthMapFactor", &units_per_metre, Range::Between(1e-3, 1e6),
              "units of the 16-bit depth images per metre");
  options.Add("ThDepth", &close_baselines, Range::Between(1e-3, 1e6),
              "largest distance of a close point, in units of the baseline");
  options.Add("depth.disparity_offset", &disparity_offset, Range::Between(-20.0, 20.0),
              "disparity of depth images minus the true one, px");
  options.Add("depth.time_offset", &time_offset, Range::Between(-0.2, 0.2),
              "depth images are taken so much later than their stamps say, s");
  for (size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    options.Add("depth.turn_" + axis, &pose.at(i), Range::Between(-0.2, 0.2),
                "rotation from colour to registered depth images, rad");
    options.Add("depth.shift_" + axis, &pose.at(3 + i), Range::Between(-0.2, 0.2),
                "translation from colour to registered depth images, m");
  }
  error.Bind(options);
}

float SampleDepth(const cv::Mat& depth, const Eigen::Vector2f& raw_pixel, double units_per_metre) {
  Check(depth.type() == CV_16UC1 || depth.type() == CV_32FC1,
        "the depth image is neither CV_16UC1 nor CV_32FC1");
  const float x = std::round(raw_pixel.x());
  const float y = std::round(raw_pixel.y());
  // The comparison is written so that a NaN pixel counts as outside.
  const bool inside = x >= 0.0f && y >= 0.0f && x < static_cast<float>(depth.cols) &&
                      y < static_cast<float>(depth.rows);
  if (!inside) {
    return 0.0f;
  }
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  if (depth.type() == CV_16UC1) {
    return static_cast<float>(depth.at<uint16_t>(row, column) / units_per_metre);
  }
  const float metres = depth.at<float>(row, column);
  return std::isfinite(metres) && metres > 0.0f ? metres : 0.0f;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>

#include "hullslam/util/option_table.h"

namespace hullslam {

// The model of the error of a keypoint with depth.
enum class DepthErrorModel {
  kDisparity,    // pixel and disparity have independent errors
  kRightColumn,  // the columns of a virtual stereo pair have (src/camera/point_measurement.h)
};

// The rules for the weights of points in bundle adjustment (src/optim/bundle_options.h).
enum class AdjustmentRule { kHullslam, kOrbSlam2 };

// The error of a point seen with or without depth (src/camera/point_measurement.h).
struct DepthErrorOptions {
  DepthErrorModel model = DepthErrorModel::kDisparity;
  // Standard deviation of the coordinates of a keypoint of level 0 of the image pyramid, px. At
  // other levels it is multiplied by the scale of the level. Where features lie on whole pixels,
  // 0.7: refining them lowers the mean error of reprojection on freiburg1_xyz from 0.98 to 0.79 px,
  // so both sigmas are 0.8 times as large.
  double pixel_sigma = 0.56;
  // The same in bundle adjustment. It is larger there because it also sets the weight of points
  // against objects and the bound at which an observation is removed from the map
  // (docs/decisions.md).
  double adjustment_pixel_sigma = 0.8;
  // Standard deviation of the disparity bf / z, px, the same at all levels. Sensors are more
  // precise than the default, but the pixel that the depth is taken from need not show the
  // landmark.
  double disparity_sigma = 1.0;
  // kHullslam: without depth, the precision of keypoints is measured, keypoints that are near one
  // another share a weight, and the loss is Cauchy's. kOrbSlam2: with and without depth, fixed
  // sigmas, then Huber's loss, and no loss once the outliers are left out.
  AdjustmentRule adjustment_rule = AdjustmentRule::kHullslam;

  // The error in bundle adjustment.
  DepthErrorOptions ForAdjustment() const;

  // Binds the keys `depth.model`, `depth.pixel_sigma` and so on.
  void Bind(OptionTable& options);
};

struct DepthOptions {
  double units_per_metre = 5000.0;  // units of a 16-bit depth image per metre
  double close_baselines = 40.0;    // depths up to this many baselines count as close
  // The disparity bf / z of depth images minus the true one, px, as `hullslam calibrate` finds it.
  double disparity_offset = 0.0;
  // When and from where depth images are taken, beside what their time stamps and their
  // registration to the colour images say: so many seconds later, and with the pose
  // depth_from_colour, a rotation vector (rad) and a translation (m).
  double time_offset = 0.0;
  std::array<double, 6> pose = {};
  DepthErrorOptions error = {};

  // Binds ORB-SLAM2's keys `DepthMapFactor` and `ThDepth`, and those of the section `depth`.
  void Bind(OptionTable& options);
};

// Returns the depth in metres at the pixel nearest to `raw_pixel`, or 0 if it is unknown or outside
// the image. Throws CheckError unless `depth` is CV_16UC1 or CV_32FC1, as in ImageInput.
float SampleDepth(const cv::Mat& depth, const Eigen::Vector2f& raw_pixel, double units_per_metre);

}  // namespace hullslam

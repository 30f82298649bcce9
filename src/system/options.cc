// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/options.h"

#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <string>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

void CheckMask(const cv::Mat& mask, const PinholeCamera& camera, const char* of) {
  if (mask.empty()) {
    return;
  }
  if (mask.type() != CV_8UC1) {
    throw InputError(fmt::format("the mask of all {}images is not CV_8UC1", of));
  }
  if (mask.size() != cv::Size(camera.width, camera.height)) {
    throw InputError(
        fmt::format("the mask of all {}images is {}x{} px, expected Camera.width x Camera.height, "
                    "{}x{} px",
                    of, mask.cols, mask.rows, camera.width, camera.height));
  }
  if (cv::countNonZero(mask) == 0) {
    throw InputError(fmt::format(
        "the mask of all {}images is 0 everywhere, expected other values at pixels that are used",
        of));
  }
}

}  // namespace

void RunOptions::Bind(OptionTable& options) {
  const OptionScope scope(options, "run");
  scope.Add("max_lost_share", &max_lost_share, Range::Share(),
            "the run fails (exit code 1) if a larger share of its frames has no pose");
  scope.Add("max_lost_at_end", &max_lost_at_end, Range::AtLeast(0.0),
            "the run fails (exit code 1) if no frame of a longer time at its end has a pose, s");
}

void OdometryOptions::Bind(OptionTable& options) {
  const OptionScope scope(options, "odometry");
  scope.Add("sigma_way", &sigma_way, Range::Between(0.0, 1.0),
            "standard deviation of a step of --odometry, as a share of its length");
  scope.Add("sigma_turn", &sigma_turn, Range::Between(0.0, 1.0),
            "standard deviation of a step of --odometry, as a share of its rotation");
}

OptionTable SystemOptions::Bind() {
  OptionTable table;
  camera.Bind(table);
  const OptionScope scope(table, "Camera");
  scope.Add("fps", &frames_per_second, Range::Positive(), "frame rate of the camera, 1/s");
  scope.Add(
      "readout_time", &readout_time, Range::Between(-0.1, 0.1),
      "rolling shutter: time from the top row of an image to the bottom row (columns: from left "
      "to right), s; negative: the other way round; 0: all at once");
  scope.AddEnum("readout_direction", &readout_direction, {"rows", "columns"},
                "rolling shutter: an image is exposed row after row or column after column");
  scope.Add("RGB", &rgb_order,
            "colour images that the library receives from memory are RGB (else BGR)");
  depth.Bind(table);
  features.Bind(table);
  tracking.Bind(table);
  mapping.Bind(table);
  objects.Bind(table);
  loop.Bind(table);
  odometry.Bind(table);
  run.Bind(table);
  for (const char* name :
       {"KeyFrameSize", "KeyFrameLineWidth", "GraphLineWidth", "PointSize", "CameraSize",
        "CameraLineWidth", "ViewpointX", "ViewpointY", "ViewpointZ", "ViewpointF"}) {
    table.AddIgnored(std::string("Viewer.") + name);
  }
  return table;
}

void SystemOptions::Validate() const {
  if (camera.fx <= 0.0 || camera.fy <= 0.0) {
    throw InputError("settings: Camera.fx and Camera.fy are not given, expected numbers > 0");
  }
  if (const std::string fault = camera.FindFault(); !fault.empty()) {
    throw InputError("settings: " + fault);
  }
  if (sensor == SensorKind::kStereo && camera.IsDistorted()) {
    throw InputError(
        "settings: Camera.k1 to Camera.k6 are not 0, expected no distortion: the images of a "
        "stereo camera are rectified");
  }
  if (sensor == SensorKind::kStereo && camera.bf <= 0.0) {
    throw InputError(fmt::format(
        "settings: Camera.bf is '{:g}', expected the baseline of the stereo camera times Camera.fx",
        camera.bf));
  }
  CheckMask(mask_all, camera, "");
  CheckMask(mask_all_right, camera, "right ");
  if (!mask_all_right.empty() && sensor != SensorKind::kStereo) {
    throw InputError("there is a mask of all right images, expected none without a stereo camera");
  }
  const int most_levels = features.MostLevels(camera.width, camera.height);
  if (most_levels == 0) {
    throw InputError(
        fmt::format("settings: images of {}x{} px are too small, expected at least {} px",
                    camera.width, camera.height, FeatureOptions::kSmallestSide));
  }
  if (features.level_count > most_levels) {
    throw InputError(fmt::format(
        "settings: ORBextractor.nLevels is '{}', expected at most {} for images of {}x{} px, "
        "because the smallest level must have {} px",
        features.level_count, most_levels, camera.width, camera.height,
        FeatureOptions::kSmallestSide));
  }
  objects.Validate();
}

}  // namespace hullslam

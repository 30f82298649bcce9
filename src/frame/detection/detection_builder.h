// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/features/feature_set.h"
#include "hullslam/frame/built_frame.h"
#include "hullslam/frame/detection.h"
#include "hullslam/frame/detection_options.h"
#include "hullslam/frame/instance_mask.h"
#include "util/task_runner.h"

namespace hullslam {

struct DetectionResult {
  std::vector<Detection> detections;  // one per mask that was not rejected, in the masks' order
  std::vector<std::optional<DetectionRejection>> rejections;  // one per mask
};

// Turns the masks of a frame into detections. The outlines of a mask are undistorted point by
// point. The hull encloses all parts of a mask except small ones
// (DetectionOptions::min_part_share). The primitive determines the lines. Support lines (`support`,
// the default) have the directions of the edges of the simplified hull and some evenly spread
// directions. They touch the full hull, while the edges of the simplified hull can cut through it.
// Whatever the primitive is, the lines of a box mask are its sides and the lines of an ellipse mask
// are its tangents.
//
// A line is one-sided if it touches the mask only at the border of the raw image, or at pixels that
// the mask of all images ignores. With depth it is also one-sided if something nearer to the camera
// begins just beyond it.
class DetectionBuilder {
 public:
  // `mask_all` is as in Sensor.
  DetectionBuilder(const PinholeCamera& camera, double units_per_metre,
                   const DetectionOptions& options, cv::Mat mask_all = {})
      : camera_(camera),
        units_per_metre_(units_per_metre),
        options_(options),
        mask_all_(std::move(mask_all)) {}

  // `depth` is as in ImageInput and has the size of the camera, or it is empty: then detections
  // have no points and no occlusion is found. `keypoints` are those of the frame. Throws CheckError
  // for a depth image of another size or type.
  DetectionResult Build(std::span<const InstanceMask> masks, const cv::Mat& depth,
                        std::span<const RawKeypoint> keypoints) const;
  // The same detections, with one task per mask.
  DetectionResult Build(std::span<const InstanceMask> masks, const cv::Mat& depth,
                        std::span<const RawKeypoint> keypoints, TaskRunner& runner) const;

 private:
  PinholeCamera camera_;
  double units_per_metre_;
  DetectionOptions options_;
  cv::Mat mask_all_;
};

}  // namespace hullslam

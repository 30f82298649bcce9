// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "frame/detection/detection_builder.h"
#include "hullslam/camera/depth.h"
#include "hullslam/frame/built_frame.h"
#include "hullslam/frame/instance_mask.h"
#include "hullslam/frame/sensor.h"
#include "util/task_runner.h"

namespace hullslam {

// Makes the detections of frames, from the masks of all classes that are not dynamic.
class FrameDetector {
 public:
  FrameDetector(const Sensor& sensor, const DepthOptions& depth, const DetectionOptions& options,
                std::set<std::string> dynamic_classes);

  // Adds the detections to the frame and counts the masks that gave none. `depth` and `keypoints`
  // are as in DetectionBuilder.
  void AddDetections(std::span<const InstanceMask> masks, const cv::Mat& depth,
                     std::span<const RawKeypoint> keypoints, TaskRunner& runner, BuiltFrame& built);
  // Adds the lines of masks of the right image to the detections that show the same objects, and
  // counts the masks that belong to none. To be called after AddDetections().
  void AddRightLines(std::span<const InstanceMask> masks, TaskRunner& runner, BuiltFrame& built);

 private:
  std::vector<InstanceMask> OfObjects(std::span<const InstanceMask> masks) const;

  PinholeCamera camera_;
  DetectionBuilder builder_;
  DetectionBuilder right_builder_;  // of the right image, whose keypoints are not kept
  std::set<std::string> dynamic_classes_;
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "frame/detection/detection_builder.h"
#include "hullslam/camera/depth.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/built_frame.h"
#include "hullslam/frame/detection.h"
#include "hullslam/frame/instance_mask.h"
#include "hullslam/frame/sensor.h"
#include "util/task_runner.h"

namespace hullslam {

// Gives each detection of the left image of a rectified pair (`camera`) the lines of the detection
// of the right image that shows the same object (Detection::right_lines). The two have one label,
// and their hulls have an IoU of more than 0.5 when the left one is shifted by the disparity of its
// depth points, or, without these, such that the middles of the two boxes have the same column. Two
// masks without common pixels cannot both have such an IoU with a third one, so each detection
// belongs to one of the other image. Returns the number of detections that got lines.
size_t AddLinesOfRight(std::span<const Detection> right, const PinholeCamera& camera,
                       std::vector<Detection>& left);

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

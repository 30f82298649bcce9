// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <set>
#include <span>
#include <string>

#include "frame/detection_builder.h"
#include "hullslam/camera/depth.h"
#include "hullslam/frame/built_frame.h"
#include "hullslam/frame/instance_mask.h"
#include "util/task_runner.h"

namespace hullslam {

// Makes the detections of frames, from the masks of all classes that are not dynamic.
class FrameDetector {
 public:
  FrameDetector(const PinholeCamera& camera, const DepthOptions& depth,
                const DetectionOptions& options, std::set<std::string> dynamic_classes);

  // Adds the detections to the frame and counts the masks that gave none. `depth` and `keypoints`
  // are as in DetectionBuilder.
  void AddDetections(std::span<const InstanceMask> masks, const cv::Mat& depth,
                     std::span<const RawKeypoint> keypoints, TaskRunner& runner, BuiltFrame& built);

 private:
  DetectionBuilder builder_;
  std::set<std::string> dynamic_classes_;
};

}  // namespace hullslam

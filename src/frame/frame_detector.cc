// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/frame_detector.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace hullslam {

FrameDetector::FrameDetector(const PinholeCamera& camera, const DepthOptions& depth,
                             const DetectionOptions& options, std::set<std::string> dynamic_classes)
    : builder_(camera, depth.units_per_metre, options),
      dynamic_classes_(std::move(dynamic_classes)) {}

void FrameDetector::AddDetections(std::span<const InstanceMask> masks, const cv::Mat& depth,
                                  std::span<const RawKeypoint> keypoints, TaskRunner& runner,
                                  BuiltFrame& built) {
  if (!masks.empty()) {
    std::vector<InstanceMask> of_objects;
    std::copy_if(masks.begin(), masks.end(), std::back_inserter(of_objects),
                 [&](const InstanceMask& mask) { return !dynamic_classes_.contains(mask.label); });
    DetectionResult result = builder_.Build(of_objects, depth, keypoints, runner);
    for (const std::optional<DetectionRejection>& rejection : result.rejections) {
      if (rejection) {
        ++built.masks.rejections[*rejection];
      }
    }
    built.masks.detections = result.detections.size();
    built.frame->detections = std::move(result.detections);
  }
}

}  // namespace hullslam

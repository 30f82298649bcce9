// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/frame_detector.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "frame/detection/right_lines.h"

namespace hullslam {
namespace {

DetectionOptions WithoutKeypoints(DetectionOptions options) {
  options.min_keypoints = 0;
  return options;
}

}  // namespace

FrameDetector::FrameDetector(const Sensor& sensor, const DepthOptions& depth,
                             const DetectionOptions& options, std::set<std::string> dynamic_classes)
    : camera_(sensor.camera),
      builder_(sensor.camera, depth.units_per_metre, options, sensor.mask_all),
      right_builder_(sensor.camera, depth.units_per_metre, WithoutKeypoints(options),
                     sensor.mask_all_right),
      dynamic_classes_(std::move(dynamic_classes)) {}

std::vector<InstanceMask> FrameDetector::OfObjects(std::span<const InstanceMask> masks) const {
  std::vector<InstanceMask> of_objects;
  std::copy_if(masks.begin(), masks.end(), std::back_inserter(of_objects),
               [&](const InstanceMask& mask) { return !dynamic_classes_.contains(mask.label); });
  return of_objects;
}

void FrameDetector::AddDetections(std::span<const InstanceMask> masks, const cv::Mat& depth,
                                  std::span<const RawKeypoint> keypoints, TaskRunner& runner,
                                  BuiltFrame& built) {
  if (!masks.empty()) {
    DetectionResult result = builder_.Build(OfObjects(masks), depth, keypoints, runner);
    for (const std::optional<DetectionRejection>& rejection : result.rejections) {
      if (rejection) {
        ++built.masks.rejections[*rejection];
      }
    }
    built.masks.detections = result.detections.size();
    built.frame->detections = std::move(result.detections);
  }
}

void FrameDetector::AddRightLines(std::span<const InstanceMask> masks, TaskRunner& runner,
                                  BuiltFrame& built) {
  if (masks.empty()) {
    return;
  }
  const std::vector<InstanceMask> of_objects = OfObjects(masks);
  const DetectionResult right = right_builder_.Build(of_objects, cv::Mat(), {}, runner);
  const size_t added = AddLinesOfRight(right.detections, camera_, built.frame->detections);
  built.masks.right_masks = added;
  if (added < of_objects.size()) {
    built.masks.rejections[DetectionRejection::kNotInLeft] += of_objects.size() - added;
  }
}

}  // namespace hullslam

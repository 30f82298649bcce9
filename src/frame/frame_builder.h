// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hullslam/camera/depth.h"
#include "hullslam/features/extractor.h"
#include "hullslam/frame/detection_builder.h"
#include "hullslam/frame/frame.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/frame/sensor.h"

namespace hullslam {

// Turns images into frames: extracts and undistorts keypoints, looks up their depths and virtual
// right coordinates, builds the grid, and makes the detections of objects. Things of the dynamic
// classes give no detections, and the keypoints on them are removed.
class FrameBuilder {
 public:
  // `sensor` must outlive the builder. If `detection` is empty, frames have no detections.
  FrameBuilder(const Sensor& sensor, const DepthOptions& depth, const FeatureOptions& features,
               const std::optional<DetectionOptions>& detection = DetectionOptions(),
               std::set<std::string> dynamic_classes = {});

  // Throws InputError if an image does not have the size of the camera or a type that ImageInput
  // allows. The masks must pass ValidateMasks().
  std::shared_ptr<const Frame> Build(const ImageInput& image, FrameId id);

  struct Counts {
    size_t detections = 0;
    size_t frames_with_masks = 0;
    std::map<DetectionRejection, size_t> rejections;  // masks that gave no detection, by the reason
  };
  // The counts over all frames that were built.
  const Counts& counts() const { return counts_; }

 private:
  std::vector<Detection> Detect(const ImageInput& image, const std::vector<Keypoint>& keypoints);

  const Sensor& sensor_;
  DepthOptions depth_;
  FeatureExtractor extractor_;
  std::optional<DetectionBuilder> detection_builder_;
  std::set<std::string> dynamic_classes_;
  Counts counts_;
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hullslam/camera/depth.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/features/extractor.h"
#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/frame/detection_builder.h"

namespace hullslam {

// Turns images into frames: features, undistortion, depth and virtual right coordinates, grid,
// detections of objects. Keypoints on things of the dynamic classes are left out, and so are these
// things.
class FrameBuilder {
 public:
  // `sensor` must outlive the builder. Without `detection` frames have no detections.
  FrameBuilder(const Sensor& sensor, const DepthOptions& depth, const FeatureOptions& features,
               const std::optional<DetectionOptions>& detection = DetectionOptions(),
               std::set<std::string> dynamic_classes = {});

  // Throws CheckError where the images are not of the camera's size or not of the types that
  // ImageInput says.
  std::shared_ptr<const Frame> Build(const ImageInput& image, FrameId id);

  struct Counts {
    size_t detections = 0;
    size_t frames_with_masks = 0;
    std::map<DetectionRejection, size_t> rejections;  // of masks that gave no detection
  };
  // Of all frames that were built.
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

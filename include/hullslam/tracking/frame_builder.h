// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "hullslam/camera/depth.h"
#include "hullslam/camera/rgbd_image.h"
#include "hullslam/features/extractor.h"
#include "hullslam/map/frame.h"
#include "hullslam/map/sensor.h"
#include "hullslam/objects/detection_builder.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// Turns images into frames: features, undistortion, depth and virtual right coordinates, grid,
// detections of objects. Keypoints on things of the dynamic classes are left out, and so are these
// things.
class FrameBuilder {
 public:
  // `sensor` must outlive the builder.
  FrameBuilder(const Sensor& sensor, const DepthOptions& depth, const FeatureOptions& features,
               const ObjectOptions& objects = {}, std::set<std::string> dynamic_classes = {});

  // Throws CheckError where the images are not of the camera's size or not of the types that
  // RgbdImage says.
  std::shared_ptr<const Frame> Build(const RgbdImage& image, FrameId id);

  struct Counts {
    size_t detections = 0;
    size_t frames_with_masks = 0;
    std::map<DetectionRejection, size_t> rejections;  // of masks that gave no detection
  };
  // Of all frames that were built.
  const Counts& counts() const { return counts_; }

 private:
  std::vector<Detection> Detect(const RgbdImage& image, const std::vector<Keypoint>& keypoints);

  const Sensor& sensor_;
  DepthOptions depth_;
  FeatureExtractor extractor_;
  DetectionBuilder detection_builder_;
  bool objects_enabled_;
  std::set<std::string> dynamic_classes_;
  Counts counts_;
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/camera/depth.h"
#include "hullslam/camera/rgbd_image.h"
#include "hullslam/features/extractor.h"
#include "hullslam/map/frame.h"
#include "hullslam/map/sensor.h"

namespace hullslam {

// Turns images into frames: features, undistortion, depth and virtual right coordinates, grid.
class FrameBuilder {
 public:
  // `sensor` must outlive the builder.
  FrameBuilder(const Sensor& sensor, const DepthOptions& depth, const FeatureOptions& features);

  // Throws CheckError where the images are not of the camera's size or not of the types that
  // RgbdImage says.
  std::shared_ptr<const Frame> Build(const RgbdImage& image, FrameId id);

 private:
  const Sensor& sensor_;
  DepthOptions depth_;
  FeatureExtractor extractor_;
};

}  // namespace hullslam

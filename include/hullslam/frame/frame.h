// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "hullslam/bow/bow_vector.h"
#include "hullslam/features/feature_grid.h"
#include "hullslam/frame/depth_grid.h"
#include "hullslam/frame/detection.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/util/id.h"

namespace hullslam {

struct ShutterMotion;

// The data extracted from one image. A frame does not change after it is built; the stages share
// it.
struct Frame {
  FrameId id;
  double timestamp = 0.0;  // seconds
  FrameFeatures features;
  std::vector<WordId> words;  // one per keypoint; empty without a vocabulary
  std::vector<Detection> detections;
  DepthGrid depth;           // empty without depth
  double depth_delay = 0.0;  // s, as in ImageInput
  std::optional<MotionPrior> motion;
  // How the keypoints were corrected for a rolling shutter (frame/rolling_shutter.h), for
  // detections that come later and for calibration. Null if they were not, and once there are
  // detections.
  std::shared_ptr<const ShutterMotion> shutter;
};

}  // namespace hullslam

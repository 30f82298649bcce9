// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/frame/instance_mask.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/features/feature_set.h"
#include "hullslam/frame/detection.h"
#include "hullslam/frame/detection_options.h"

namespace hullslam {

// Why a mask gives no detection.
enum class DetectionRejection {
  kLowScore,
  kDegenerate,    // no outline that has an area
  kTooSmall,      // its box
  kTooLarge,      // its hull
  kFewKeypoints,  // in it
  kDuplicate,     // another mask of a higher score shows the same object
  kNoSilhouette,  // all its sides are cut by the border of the image or hidden
};
inline constexpr int kDetectionRejectionCount = 7;

// As in summary.json: "low_score".
std::string ToString(DetectionRejection reason);

struct DetectionResult {
  std::vector<Detection> detections;  // of the masks that were not rejected, in their order
  std::vector<std::optional<DetectionRejection>> rejections;  // one a mask
};

// Turns the masks of a frame into detections. Outlines are undistorted point by point, the parts of
// a mask that are at least a tenth of its largest one are put into one hull, and lines are taken of
// it: `support` (default) lines have the directions of the edges of the simplified hull and some
// evenly spread ones, and touch the full hull, so that, unlike those edges, they do not cut inside.
// Of a mask that is a box they are its sides and of an ellipse its tangents, whatever is asked for.
//
// One-sided are lines that touch the mask only at the border of the raw image, and, with depth,
// those beyond which something nearer begins.
class DetectionBuilder {
 public:
  DetectionBuilder(const PinholeCamera& camera, double units_per_metre,
                   const DetectionOptions& options)
      : camera_(camera), units_per_metre_(units_per_metre), options_(options) {}

  // `depth` as in ImageInput, of the size of the camera, or empty: then no points are taken and no
  // occlusion is seen. `keypoints` are those of the frame. Throws CheckError for a depth image of
  // another size or type.
  DetectionResult Build(std::span<const InstanceMask> masks, const cv::Mat& depth,
                        std::span<const Keypoint> keypoints) const;

 private:
  PinholeCamera camera_;
  double units_per_metre_;
  DetectionOptions options_;
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hullslam/features/feature_set.h"
#include "hullslam/frame/frame.h"

namespace hullslam {

// Why a mask gives no detection.
enum class DetectionRejection {
  kLowScore,
  kDegenerate,    // no contour of the mask has an area
  kTooSmall,      // the bounding box of the mask is too small
  kTooLarge,      // the hull of the mask is too large
  kFewKeypoints,  // too few keypoints are in the mask
  kDuplicate,     // another mask with a higher score shows the same object
  kNoSilhouette,  // all lines of the mask are one-sided
  kNotInLeft,     // no detection of the left image belongs to a mask of the right image
};
inline constexpr int kDetectionRejectionCount = 8;

// The name in summary.json, such as "low_score".
std::string ToString(DetectionRejection reason);

// The numbers of masks of one or more frames that became detections, and that did not, by reason.
struct DetectionCounts {
  size_t detections = 0;
  size_t frames_with_masks = 0;
  std::map<DetectionRejection, size_t> rejections;  // masks that gave no detection, by the reason
  size_t right_masks = 0;  // detections that have lines of a mask of the right image, too

  void Add(const DetectionCounts& other);
};

// What the detections of a frame are made from, besides its masks.
struct DetectionInput {
  cv::Mat depth;                       // as in ImageInput
  std::vector<RawKeypoint> keypoints;  // those of the frame
};

// A frame that is not tracked yet. Building it needs no map, so it can be done ahead of tracking.
struct BuiltFrame {
  std::unique_ptr<Frame> frame;  // its id is set when it is tracked
  DetectionCounts masks;
  std::chrono::steady_clock::time_point begin;  // when building began
  double milliseconds = 0.0;                    // how long building took
  // For masks that come later (System::AddMasks); null if the masks of the frame are known.
  std::shared_ptr<const DetectionInput> awaiting = nullptr;
};

}  // namespace hullslam

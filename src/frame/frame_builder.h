// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "camera/fit_depth.h"
#include "features/extractor.h"
#include "frame/depth_source.h"
#include "frame/detection/frame_detector.h"
#include "frame/input_check.h"
#include "hullslam/bow/vocabulary.h"
#include "hullslam/camera/depth.h"
#include "hullslam/frame/built_frame.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/frame/sensor.h"
#include "util/task_runner.h"

namespace hullslam {

// Turns images into frames: extracts and undistorts keypoints, finds their
// depths, builds the grid, and makes the detections of objects. Things of the dynamic
// classes give no detections, and no keypoints are chosen on them unless this is switched off, nor
// at pixels that Sensor::mask_all ignores. With a vocabulary it looks up the word of each keypoint.
class FrameBuilder {
 public:
  // `sensor` must outlive the builder. If `detection` is empty, frames have no detections.
  // If `vocabulary` is null, they have no words.
  FrameBuilder(const Sensor& sensor, const DepthOptions& depth, const FeatureOptions& features,
               const std::optional<DetectionOptions>& detection = DetectionOptions(),
               std::set<std::string> dynamic_classes = {},
               std::shared_ptr<const Vocabulary> vocabulary = nullptr, bool remove_dynamic = true);

  // Throws InputError if an image does not have the size of the camera or a type that ImageInput
  // allows, if the sensor has another image than a depth or a right image, or if InputCheck refuses
  // the images. The masks must pass ValidateMasks().
  // If a frame without masks `awaits_masks`, it keeps what AddDetections() needs.
  // Words are looked up at once if `finds_words`, else when they are first asked for.
  BuiltFrame Build(const ImageInput& image, TaskRunner& runner, bool awaits_masks = false,
                   bool finds_words = true);

  // Messages for the user about input that can be used, but hardly is what was meant (InputCheck).
  // May be called by another thread.
  std::vector<std::string> warnings() const { return check_.warnings(); }
  void Warn(std::string warning) { check_.Warn(std::move(warning)); }

  // Adds the detections of masks that come after the frame was built, and counts the masks.
  // `input` is BuiltFrame::awaiting. May be called while another thread calls Build.
  void AddDetections(std::span<const InstanceMask> masks, const DetectionInput& input,
                     TaskRunner& runner, BuiltFrame& built);
  // The keypoints that Build would not have chosen with these masks, by increasing index. May be
  // called while another thread calls Build.
  std::vector<uint32_t> DynamicKeypoints(std::span<const InstanceMask> masks,
                                         const DetectionInput& input) const;

 private:
  // `image` has depth of its own size.
  BuiltFrame BuildFitted(const ImageInput& image, TaskRunner& runner, bool awaits_masks,
                         bool finds_words);
  // Returns the keypoints as they are in the raw image.
  std::vector<RawKeypoint> AddFeatures(const ImageInput& image, TaskRunner& runner,
                                       FrameFeatures& features);
  const Sensor& sensor_;
  DepthOptions depth_;
  InputCheck check_;
  FeatureExtractor extractor_;
  std::unique_ptr<DepthSource> source_;
  std::optional<FrameDetector> detector_;
  std::optional<DepthReprojection> registration_;  // if depth images need it
  std::set<std::string> dynamic_classes_;
  std::shared_ptr<const Vocabulary> vocabulary_;
  bool remove_dynamic_;
  // The pixels that are not used in any image or in any right image (255); empty if all are.
  cv::Mat unused_;
  cv::Mat unused_right_;
};

}  // namespace hullslam

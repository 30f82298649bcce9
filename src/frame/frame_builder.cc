// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/frame_builder.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "hullslam/frame/dynamic_mask.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

void CheckSize(const char* name, const cv::Mat& image, const cv::Size& size) {
  if (image.size() != size) {
    throw InputError(
        fmt::format("the {} is {}x{} px, expected Camera.width x Camera.height, {}x{} px", name,
                    image.cols, image.rows, size.width, size.height));
  }
}

void Undistort(const PinholeCamera& camera, std::vector<Keypoint>& keypoints) {
  for (Keypoint& keypoint : keypoints) {
    keypoint.undistorted = camera.Undistort(keypoint.raw.cast<double>()).cast<float>();
  }
}

void AddDepth(const Sensor& sensor, const cv::Mat& depth, double units_per_metre,
              FrameFeatures& features) {
  features.depth.reserve(features.size());
  features.right_u.reserve(features.size());
  for (const Keypoint& keypoint : features.keypoints) {
    const float z = SampleDepth(depth, keypoint.raw, units_per_metre);
    features.depth.push_back(z);
    features.right_u.push_back(VirtualRight(keypoint.undistorted.x(), z, sensor.camera.bf));
  }
}

}  // namespace

FrameBuilder::FrameBuilder(const Sensor& sensor, const DepthOptions& depth,
                           const FeatureOptions& features,
                           const std::optional<DetectionOptions>& detection,
                           std::set<std::string> dynamic_classes)
    : sensor_(sensor),
      depth_(depth),
      extractor_(features),
      dynamic_classes_(std::move(dynamic_classes)) {
  if (detection) {
    detection_builder_.emplace(sensor.camera, depth.units_per_metre, *detection);
  }
}

BuiltFrame FrameBuilder::Build(const ImageInput& image, TaskRunner& runner) {
  using Clock = std::chrono::steady_clock;
  const cv::Size size(sensor_.camera.width, sensor_.camera.height);
  CheckSize("image", image.grey, size);
  CheckSize("depth image", image.depth, size);
  if (image.grey.type() != CV_8UC1) {
    throw InputError("the image is not CV_8UC1");
  }
  if (image.depth.type() != CV_16UC1 && image.depth.type() != CV_32FC1) {
    throw InputError("the depth image is neither CV_16UC1 nor CV_32FC1");
  }
  BuiltFrame built{.frame = std::make_unique<Frame>(), .masks = {}, .begin = Clock::now()};
  built.frame->timestamp = image.timestamp;
  AddFeatures(image, runner, built.frame->features);
  built.masks.frames_with_masks = image.masks.empty() ? 0 : 1;
  has_seen_masks_ |= !image.masks.empty();
  if (detection_builder_ && !image.masks.empty()) {
    AddDetections(image, runner, built);
  }
  if (detection_builder_ && has_seen_masks_) {
    built.frame->depth = DepthGrid(image.depth, depth_.units_per_metre);
  }
  built.milliseconds =
      std::chrono::duration<double, std::milli>(Clock::now() - built.begin).count();
  return built;
}

void FrameBuilder::AddFeatures(const ImageInput& image, TaskRunner& runner,
                               FrameFeatures& features) {
  ExtractedFeatures extracted = extractor_.Extract(image.grey, runner);
  features.keypoints = std::move(extracted.keypoints);
  features.descriptors = std::move(extracted.descriptors);
  if (const cv::Mat mask = DynamicMask(image.masks, dynamic_classes_, image.grey.size());
      !mask.empty()) {
    RemoveMasked(mask, features.keypoints, features.descriptors);
  }
  Undistort(sensor_.camera, features.keypoints);
  AddDepth(sensor_, image.depth, depth_.units_per_metre, features);
  const PinholeCamera::Bounds& bounds = sensor_.bounds;
  features.grid =
      FeatureGrid(features.keypoints, Eigen::Vector2d(bounds.min_x, bounds.min_y).cast<float>(),
                  Eigen::Vector2d(bounds.max_x, bounds.max_y).cast<float>());
}

void FrameBuilder::AddDetections(const ImageInput& image, TaskRunner& runner,
                                 BuiltFrame& built) const {
  std::vector<InstanceMask> masks = image.masks;
  std::erase_if(masks,
                [&](const InstanceMask& mask) { return dynamic_classes_.contains(mask.label); });
  DetectionResult result =
      detection_builder_->Build(masks, image.depth, built.frame->features.keypoints, runner);
  for (const std::optional<DetectionRejection>& rejection : result.rejections) {
    if (rejection) {
      ++built.masks.rejections[*rejection];
    }
  }
  built.masks.detections = result.detections.size();
  built.frame->detections = std::move(result.detections);
}

}  // namespace hullslam

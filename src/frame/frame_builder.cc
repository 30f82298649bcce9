// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/frame_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <span>
#include <utility>

#include "camera/fit_depth.h"
#include "frame/detection/mask_region.h"
#include "frame/keypoint_grid.h"

namespace hullslam {
namespace {

// The pixels of the masks and those about them.
cv::Rect RegionOf(std::span<const InstanceMask> masks, const cv::Size& size) {
  // px. The depths at 8 px beyond a line tell whether something hides an object; blocks are larger.
  constexpr double kAbout = 12.0;
  const cv::Rect image({0, 0}, size);
  Eigen::AlignedBox2d box;
  for (const InstanceMask& mask : masks) {
    for (const auto& outline : mask.outlines) {
      std::ranges::for_each(outline, [&](const Eigen::Vector2d& point) { box.extend(point); });
    }
  }
  if (box.isEmpty()) {
    return {};
  }
  const auto pixel = [](double value) { return static_cast<int>(std::clamp(value, -1e6, 1e6)); };
  const Eigen::Vector2d first = box.min().array() - kAbout;
  const Eigen::Vector2d last = box.max().array() + kAbout;
  return cv::Rect(cv::Point(pixel(first.x()), pixel(first.y())),
                  cv::Point(pixel(last.x()) + 1, pixel(last.y()) + 1)) &
         image;
}

void AddKeypoints(std::span<const RawKeypoint> keypoints, const PinholeCamera& camera,
                  TaskRunner& runner, FrameFeatures& features) {
  features.keypoints.resize(keypoints.size());
  runner.RunEach(keypoints.size(), [&](size_t i) {
    const RawKeypoint& keypoint = keypoints[i];
    const Eigen::Vector2f undistorted = camera.Undistort(keypoint.raw.cast<double>()).cast<float>();
    features.keypoints[i] = {
        .undistorted = undistorted, .angle = keypoint.angle, .level = keypoint.level};
  });
}

// The pixels that are 0 in the mask of all images, and those beyond the largest angle of a wide
// lens; empty if there are none.
cv::Mat UnusedPixels(const PinholeCamera& camera, const cv::Mat& mask_all) {
  cv::Mat unused = mask_all.empty() ? cv::Mat() : cv::Mat(mask_all == 0);
  if (camera.IsWide()) {
    if (unused.empty()) {
      unused = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
    }
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        if (!camera.SeesRaw({x, y})) {
          unused.at<unsigned char>(y, x) = 255;
        }
      }
    }
  }
  return unused;
}

// The pixels of either mask. Both may be empty.
cv::Mat Union(const cv::Mat& a, const cv::Mat& b) {
  return a.empty() ? b : b.empty() ? a : cv::Mat(a | b);
}

FeatureOptions FeaturesOf(const Sensor& sensor, FeatureOptions features) {
  features.keep_edges = features.keep_edges || !sensor.IsMonocular();
  return features;
}

}  // namespace

FrameBuilder::FrameBuilder(const Sensor& sensor, const DepthOptions& depth,
                           const FeatureOptions& features,
                           const std::optional<DetectionOptions>& detection,
                           std::set<std::string> dynamic_classes,
                           std::shared_ptr<const Vocabulary> vocabulary, bool remove_dynamic)
    : sensor_(sensor),
      depth_(depth),
      check_(sensor, depth),
      extractor_(FeaturesOf(sensor, features)),
      source_(MakeDepthSource(sensor, depth, FeaturesOf(sensor, features), check_)),
      dynamic_classes_(std::move(dynamic_classes)),
      vocabulary_(std::move(vocabulary)),
      remove_dynamic_(remove_dynamic),
      unused_(UnusedPixels(sensor.camera, sensor.mask_all)),
      unused_right_(UnusedPixels(sensor.camera, sensor.mask_all_right)) {
  if (depth_.pose != decltype(depth_.pose){} && sensor.kind == SensorKind::kRgbd) {
    registration_.emplace(sensor.camera, depth_.pose);
  }
  if (detection) {
    detector_.emplace(sensor, depth, *detection, dynamic_classes_);
  }
}

BuiltFrame FrameBuilder::Build(const ImageInput& image, TaskRunner& runner, bool awaits_masks,
                               bool finds_words) {
  CheckGreyImage("image", image.grey, sensor_.camera);
  source_->CheckImages(image);
  check_.CheckDepth(image.depth);
  const bool is_fitted =
      image.depth.size() == image.grey.size() && depth_.disparity_offset == 0.0 && !registration_;
  if (image.depth.empty() || is_fitted) {
    return BuildFitted(image, runner, awaits_masks, finds_words);
  }
  ImageInput fitted = image;
  fitted.depth =
      WithoutDisparityOffset(FitDepth(image.depth, image.grey.size()), depth_.disparity_offset,
                             sensor_.camera.bf, depth_.units_per_metre);
  if (registration_) {
    fitted.depth = registration_->Register(fitted.depth, depth_.units_per_metre);
  }
  return BuildFitted(fitted, runner, awaits_masks, finds_words);
}

BuiltFrame FrameBuilder::BuildFitted(const ImageInput& image, TaskRunner& runner, bool awaits_masks,
                                     bool finds_words) {
  using Clock = std::chrono::steady_clock;
  BuiltFrame built{.frame = std::make_unique<Frame>(), .masks = {}, .begin = Clock::now()};
  built.frame->timestamp = image.timestamp;
  built.frame->motion = image.motion;
  built.frame->depth_delay = image.depth_delay;
  DetectionInput input;
  input.keypoints = AddFeatures(image, runner, built.frame->features);
  if (vocabulary_ != nullptr && built.frame->features.size() > 0) {
    const std::vector<Descriptor>& descriptors = built.frame->features.descriptors;
    built.frame->words = finds_words ? FrameWords(vocabulary_->WordsOf(descriptors))
                                     : FrameWords([vocabulary = vocabulary_, descriptors] {
                                         return vocabulary->WordsOf(descriptors);
                                       });
  }
  built.frame->depth = DepthGrid(image.depth, depth_.units_per_metre);
  const bool is_awaiting = awaits_masks && detector_ && image.masks.empty();
  if (detector_) {
    const cv::Rect all(0, 0, image.grey.cols, image.grey.rows);
    const cv::Rect region = is_awaiting ? all : RegionOf(image.masks, image.grey.size());
    input.depth = source_->DepthIn(region, image, built.frame->features.depth, runner);
  }
  if (is_awaiting) {
    input.depth = input.depth.clone();  // the caller may write the next image there
    built.awaiting = std::make_shared<const DetectionInput>(std::move(input));
  } else {
    AddDetections(image.masks, input, runner, built);
  }
  if (detector_ && !is_awaiting) {
    detector_->AddRightLines(image.right_masks, runner, built);
  }
  built.milliseconds =
      std::chrono::duration<double, std::milli>(Clock::now() - built.begin).count();
  return built;
}

void FrameBuilder::AddDetections(std::span<const InstanceMask> masks, const DetectionInput& input,
                                 TaskRunner& runner, BuiltFrame& built) {
  built.masks.frames_with_masks = masks.empty() ? 0 : 1;
  if (detector_) {
    detector_->AddDetections(masks, input.depth, input.keypoints, runner, built);
  }
}

std::vector<uint32_t> FrameBuilder::DynamicKeypoints(std::span<const InstanceMask> masks,
                                                     const DetectionInput& input) const {
  std::vector<uint32_t> dynamic;
  if (remove_dynamic_) {
    const cv::Mat mask =
        DynamicMask(masks, dynamic_classes_, {sensor_.camera.width, sensor_.camera.height});
    for (uint32_t i = 0; i < input.keypoints.size(); ++i) {
      if (IsIgnored(mask, input.keypoints[i].raw)) {
        dynamic.push_back(i);
      }
    }
  }
  return dynamic;
}

std::vector<RawKeypoint> FrameBuilder::AddFeatures(const ImageInput& image, TaskRunner& runner,
                                                   FrameFeatures& features) {
  // The keypoints are chosen from what is left, so that as many are found as in other images.
  const auto ignored_by = [&](const cv::Mat& unused, const std::vector<InstanceMask>& masks) {
    return remove_dynamic_ ? Union(unused, DynamicMask(masks, dynamic_classes_, image.grey.size()))
                           : unused;
  };
  auto [extracted, depths] = source_->Extract(
      extractor_, image,
      {ignored_by(unused_, image.masks), ignored_by(unused_right_, image.right_masks)}, runner);
  features.depth = std::move(depths);
  features.descriptors = std::move(extracted.descriptors);
  AddKeypoints(extracted.keypoints, sensor_.camera, runner, features);
  features.grid = MakeKeypointGrid(features.keypoints, sensor_.camera);
  return std::move(extracted.keypoints);
}

}  // namespace hullslam

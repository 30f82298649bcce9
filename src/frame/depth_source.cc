// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/depth_source.h"

#include <fmt/format.h>

#include <cstddef>

#include "camera/fit_depth.h"
#include "frame/coarse_depth.h"
#include "frame/keypoint_depth.h"
#include "frame/stereo_features.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

void ExpectNoDepth(const ImageInput& image, const char* expected) {
  if (!image.depth.empty()) {
    throw InputError(fmt::format("there is a depth image, expected {}", expected));
  }
}

void ExpectNoRight(const ImageInput& image) {
  if (!image.right.empty() || !image.right_masks.empty()) {
    throw InputError(
        fmt::format("there {}, expected none without a stereo camera",
                    image.right.empty() ? "are masks of a right image" : "is a right image"));
  }
}

class NoDepth : public DepthSource {
 public:
  void CheckImages(const ImageInput& image) const override {
    ExpectNoDepth(image, "none from a monocular camera");
    ExpectNoRight(image);
  }

  Features Extract(FeatureExtractor& extractor, const ImageInput& image,
                   const std::array<cv::Mat, 2>& ignored, TaskRunner& runner) override {
    Features features;
    features.extracted = extractor.Extract(image.grey, runner, ignored[0]);
    features.depths.resize(features.extracted.keypoints.size());
    return features;
  }

  cv::Mat DepthIn(const cv::Rect& /*region*/, const ImageInput& /*image*/,
                  std::span<const float> /*depths*/, TaskRunner& /*runner*/) const override {
    return {};
  }
};

class DepthOfImage : public DepthSource {
 public:
  DepthOfImage(const Sensor& sensor, const DepthOptions& options)
      : sensor_(sensor), options_(options) {}

  void CheckImages(const ImageInput& image) const override {
    if (image.depth.empty()) {
      throw InputError(
          "there is no depth image, expected one of an RGB-D camera; without depth, "
          "SystemOptions::sensor is SensorKind::kMonocular");
    }
    CheckDepthImage(image.depth, sensor_.camera);
    ExpectNoRight(image);
  }

  Features Extract(FeatureExtractor& extractor, const ImageInput& image,
                   const std::array<cv::Mat, 2>& ignored, TaskRunner& runner) override {
    Features features;
    features.extracted = extractor.Extract(image.grey, runner, ignored[0]);
    for (const RawKeypoint& keypoint : features.extracted.keypoints) {
      const auto scale =
          static_cast<double>(sensor_.levels.scale[static_cast<size_t>(keypoint.level)]);
      features.depths.push_back(
          KeypointDepth(image.depth, keypoint, scale, sensor_.camera.bf, options_));
    }
    return features;
  }

  cv::Mat DepthIn(const cv::Rect& /*region*/, const ImageInput& image,
                  std::span<const float> /*depths*/, TaskRunner& /*runner*/) const override {
    return image.depth;
  }

 private:
  const Sensor& sensor_;
  DepthOptions options_;
};

class DepthOfPair : public DepthSource {
 public:
  DepthOfPair(const Sensor& sensor, const FeatureOptions& features, InputCheck& check)
      : camera_(sensor.camera), check_(check), stereo_(features, sensor.camera) {}

  void CheckImages(const ImageInput& image) const override {
    ExpectNoDepth(image, "the right image of a stereo camera");
    if (image.right.empty()) {
      throw InputError("there is no right image, expected one of a stereo camera");
    }
    CheckGreyImage("right image", image.right, camera_);
  }

  Features Extract(FeatureExtractor& extractor, const ImageInput& image,
                   const std::array<cv::Mat, 2>& ignored, TaskRunner& runner) override {
    Features features;
    features.extracted = stereo_.Extract(extractor, image.grey, image.right, runner, ignored);
    features.depths =
        DepthOrDisparity(stereo_.FindDisparities(features.extracted, extractor.pyramid(), runner));
    check_.CheckPair(features.extracted, stereo_.right(), features.depths);
    return features;
  }

  // The keypoints on an object are too few to show its surface.
  cv::Mat DepthIn(const cv::Rect& region, const ImageInput& image, std::span<const float> depths,
                  TaskRunner& runner) const override {
    if (region.empty()) {
      return {};
    }
    const std::vector<float> disparities = DepthOrDisparity({depths.begin(), depths.end()});
    return CoarseDepth(image.grey, image.right, camera_, {region, disparities}, runner);
  }

 private:
  // Depths (m) of disparities (px), and disparities of depths. Unknown ones are 0.
  std::vector<float> DepthOrDisparity(std::vector<float> values) const {
    for (float& value : values) {
      value = value > 0.0F ? static_cast<float>(camera_.bf / static_cast<double>(value)) : 0.0F;
    }
    return values;
  }

  PinholeCamera camera_;
  InputCheck& check_;
  StereoFeatures stereo_;
};

}  // namespace

std::unique_ptr<DepthSource> MakeDepthSource(const Sensor& sensor, const DepthOptions& depth,
                                             const FeatureOptions& features, InputCheck& check) {
  switch (sensor.kind) {
    case SensorKind::kRgbd:
      return std::make_unique<DepthOfImage>(sensor, depth);
    case SensorKind::kStereo:
      return std::make_unique<DepthOfPair>(sensor, features, check);
    case SensorKind::kMonocular:
      break;
  }
  return std::make_unique<NoDepth>();
}

void CheckGreyImage(const char* name, const cv::Mat& image, const PinholeCamera& camera) {
  if (image.cols != camera.width || image.rows != camera.height) {
    throw InputError(
        fmt::format("the {} is {}x{} px, expected Camera.width x Camera.height, {}x{} px", name,
                    image.cols, image.rows, camera.width, camera.height));
  }
  if (image.type() != CV_8UC1) {
    throw InputError(fmt::format("the {} is not CV_8UC1", name));
  }
}

void CheckDepthImage(const cv::Mat& depth, const PinholeCamera& camera) {
  if (!HaveSameShape(depth.size(), {camera.width, camera.height})) {
    throw InputError(
        fmt::format("the depth image is {}x{} px, expected the shape of the image, Camera.width x "
                    "Camera.height, {}x{} px",
                    depth.cols, depth.rows, camera.width, camera.height));
  }
  if (depth.type() != CV_16UC1 && depth.type() != CV_32FC1) {
    throw InputError("the depth image is neither CV_16UC1 nor CV_32FC1");
  }
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/depth_source.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "camera/fit_depth.h"
#include "frame/coarse_depth.h"
#include "frame/stereo_matcher.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

constexpr double kReach = 3.0;  // px at the level of the keypoint; the circle of FAST
constexpr double kDiagonal = kReach / std::numbers::sqrt2;
// px, of the disparity of a virtual stereo pair. That of a first Kinect has an error of 0.06 px
// with bf = 40 (Khoshelham and Elberink 2012), the mean of two less that of a third one 0.07 px.
constexpr double kMostBend = 0.3;

// Half of the circle; the other points are opposite to these.
constexpr std::array<std::array<double, 2>, 4> kHalfCircle = {
    {{kReach, 0.0}, {kDiagonal, kDiagonal}, {0.0, kReach}, {-kDiagonal, kDiagonal}}};

}  // namespace

float KeypointDepth(const cv::Mat& depth, const RawKeypoint& keypoint, double scale, double bf,
                    const DepthOptions& options) {
  const auto sample = [&](const Eigen::Vector2f& raw) {
    return SampleDepth(depth, raw, options.units_per_metre);
  };
  const float centre = sample(keypoint.raw);
  if (centre <= 0.0F || options.error.model == DepthErrorModel::kRightColumn) {
    return centre;
  }
  for (const auto& point : kHalfCircle) {
    const Eigen::Vector2f offset = (scale * Eigen::Vector2d(point[0], point[1])).cast<float>();
    const auto one = static_cast<double>(sample(keypoint.raw + offset));
    const auto other = static_cast<double>(sample(keypoint.raw - offset));
    if (one > 0.0 && other > 0.0) {
      const double bend = 0.5 * (1.0 / one + 1.0 / other) - 1.0 / static_cast<double>(centre);
      if (bf * std::abs(bend) > kMostBend) {
        return 0.0F;
      }
    }
  }
  return centre;
}

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
    ExtractedFeatures extracted = extractor.Extract(image.grey, runner, ignored[0]);
    std::vector<float> depths(extracted.keypoints.size());
    return {.extracted = std::move(extracted), .depths = std::move(depths)};
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
    const std::vector<RawKeypoint>& keypoints = features.extracted.keypoints;
    features.depths.resize(keypoints.size());
    runner.RunEach(keypoints.size(), [&](size_t i) {
      const auto scale =
          static_cast<double>(sensor_.levels.scale[static_cast<size_t>(keypoints[i].level)]);
      features.depths[i] =
          KeypointDepth(image.depth, keypoints[i], scale, sensor_.camera.bf, options_);
    });
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/extractor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "features/corners.h"
#include "features/orb_descriptor.h"
#include "features/pyramid.h"
#include "features/quadtree_selection.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

constexpr int kSmallestSide = 64;  // px

// Distributes the features over the levels: their number falls by the scale factor from level to
// level. The top level gets the rest.
std::vector<size_t> LevelQuotas(const FeatureOptions& options) {
  const double ratio = 1.0 / options.scale_factor;
  double wanted =
      options.feature_count * (1.0 - ratio) / (1.0 - std::pow(ratio, options.level_count));
  std::vector<size_t> quotas;
  int left = options.feature_count;
  for (int l = 0; l + 1 < options.level_count; ++l) {
    const int quota = std::min(left, static_cast<int>(std::lround(wanted)));
    quotas.push_back(static_cast<size_t>(quota));
    left -= quota;
    wanted *= ratio;
  }
  quotas.push_back(static_cast<size_t>(left));
  return quotas;
}

}  // namespace

void FeatureOptions::Bind(OptionTable& options) {
  options.Add("ORBextractor.nFeatures", &feature_count, Range::Between(1, 100000),
              "number of features to extract from an image");
  options.Add("ORBextractor.scaleFactor", &scale_factor,
              {.low = 1.0, .high = 2.0, .low_open = true},
              "ratio of the sizes of neighbouring levels of the image pyramid");
  options.Add("ORBextractor.nLevels", &level_count, Range::Between(1, 16),
              "number of levels of the image pyramid");
  options.Add("ORBextractor.iniThFAST", &initial_fast_threshold, Range::Between(1, 255),
              "FAST threshold, grey levels");
  options.Add("ORBextractor.minThFAST", &minimum_fast_threshold, Range::Between(1, 255),
              "FAST threshold in regions without corners at the first threshold, grey levels");
  options.Add("ORBextractor.subpixel", &subpixel,
              "refine the positions of features within a pixel of their level");
}

struct FeatureExtractor::Impl {
  explicit Impl(const FeatureOptions& options)
      : levels(ScaleLevels::Create(options.level_count, options.scale_factor)),
        quotas(LevelQuotas(options)),
        pyramid(levels),
        detector(options.initial_fast_threshold, options.minimum_fast_threshold),
        subpixel(options.subpixel) {}

  // Appends the features of level l.
  void ExtractLevel(int l, ExtractedFeatures& features);
  void Describe(const Corner& corner, int l, ExtractedFeatures& features) const;

  ScaleLevels levels;
  std::vector<size_t> quotas;
  ImagePyramid pyramid;
  CornerDetector detector;
  bool subpixel;
  QuadtreeSelection selection;
  std::vector<Corner> corners;
  std::vector<Corner> selected;
  cv::Mat blurred;
};

void FeatureExtractor::Impl::ExtractLevel(int l, ExtractedFeatures& features) {
  const cv::Mat& image = pyramid.level(l);
  detector.Detect(image, kPatchReach, corners);
  selection.Select(corners, image.size(), quotas[static_cast<size_t>(l)], selected);
  if (selected.empty()) {
    return;
  }
  cv::GaussianBlur(image, blurred, cv::Size(7, 7), 2.0, 2.0, cv::BORDER_REFLECT_101);
  for (const Corner& corner : selected) {
    Describe(corner, l, features);
  }
}

void FeatureExtractor::Impl::Describe(const Corner& corner, int l,
                                      ExtractedFeatures& features) const {
  const cv::Point center(corner.x, corner.y);
  const Orientation orientation = ComputeOrientation(pyramid.level(l), center);
  Keypoint keypoint;
  Eigen::Vector2f position(corner.x, corner.y);
  if (subpixel) {
    position += SubpixelOffset(corner);
  }
  keypoint.raw = pyramid.ToLevelZero(position, l);
  keypoint.undistorted = keypoint.raw;
  keypoint.angle = orientation.Angle();
  keypoint.response = corner.score;
  keypoint.level = l;
  features.keypoints.push_back(keypoint);
  features.descriptors.push_back(ComputeDescriptor(blurred, center, orientation));
}

FeatureExtractor::FeatureExtractor(const FeatureOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
FeatureExtractor::~FeatureExtractor() = default;
FeatureExtractor::FeatureExtractor(FeatureExtractor&&) noexcept = default;
FeatureExtractor& FeatureExtractor::operator=(FeatureExtractor&&) noexcept = default;

const ScaleLevels& FeatureExtractor::levels() const { return impl_->levels; }

ExtractedFeatures FeatureExtractor::Extract(const cv::Mat& grey) {
  Check(grey.type() == CV_8UC1, "the image is not CV_8UC1");
  Check(std::min(grey.cols, grey.rows) >= kSmallestSide, "the image is smaller than 64 x 64 px");
  impl_->pyramid.Build(grey);
  ExtractedFeatures features;
  size_t expected = 0;
  for (const size_t quota : impl_->quotas) {
    expected += quota + 2;
  }
  features.keypoints.reserve(expected);
  features.descriptors.reserve(expected);
  for (int l = 0; l < impl_->levels.count(); ++l) {
    impl_->ExtractLevel(l, features);
  }
  return features;
}

}  // namespace hullslam

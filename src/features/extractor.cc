// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/extractor.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "features/corners.h"
#include "features/orb_descriptor.h"
#include "features/pyramid.h"
#include "features/quadtree_selection.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// Distributes the features over the levels. Their number falls by the scale factor from level to
// level, and the top level gets the rest. If `halves_levels`, every other level gets those of two
// and a quarter more, because a corner that one level alone shows is then missed.
std::vector<size_t> LevelQuotas(const FeatureOptions& options, bool halves_levels) {
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
  for (size_t l = 1; halves_levels && l < quotas.size(); l += 2) {
    quotas[l - 1] = 5 * (quotas[l - 1] + quotas[l]) / 4;
  }
  return quotas;
}

// Extracts the features of one level. Keeps its buffers from image to image.
class LevelExtractor {
 public:
  LevelExtractor(const FeatureOptions& options, int level, size_t quota)
      : level_(level),
        quota_(quota),
        subpixel_(options.subpixel),
        keep_edges_(options.keep_edges),
        detector_(options.initial_fast_threshold, options.minimum_fast_threshold) {}

  void Extract(const ImagePyramid& pyramid, const cv::Mat& ignored);
  const ExtractedFeatures& features() const { return features_; }

 private:
  Eigen::Vector2f PositionOf(const Corner& corner, const ImagePyramid& pyramid) const;
  void Select(const cv::Mat& image);
  void Describe(const Corner& corner, const ImagePyramid& pyramid, const cv::Mat& blurred);

  int level_;
  size_t quota_;
  bool subpixel_;
  bool keep_edges_;
  CornerDetector detector_;
  QuadtreeSelection selection_;
  OrbBlur blur_;
  std::vector<Corner> corners_;
  std::vector<Corner> on_edges_;
  std::vector<Corner> selected_;
  ExtractedFeatures features_;
};

void LevelExtractor::Extract(const ImagePyramid& pyramid, const cv::Mat& ignored) {
  features_.keypoints.clear();
  features_.descriptors.clear();
  const cv::Mat& image = pyramid.level(level_);
  std::function<bool(const Corner&)> is_ignored;
  if (!ignored.empty()) {
    is_ignored = [&](const Corner& corner) {
      return IsIgnored(ignored, PositionOf(corner, pyramid));
    };
  }
  detector_.Detect(image, kPatchReach, corners_, is_ignored);
  Select(image);
  if (selected_.empty()) {
    return;
  }
  const cv::Mat& blurred = blur_.Blur(image);
  for (const Corner& corner : selected_) {
    Describe(corner, pyramid, blurred);
  }
}

// The position of a corner in the raw image.
Eigen::Vector2f LevelExtractor::PositionOf(const Corner& corner,
                                           const ImagePyramid& pyramid) const {
  Eigen::Vector2f position(corner.x, corner.y);
  if (subpixel_) {
    position += SubpixelOffset(corner);
  }
  return pyramid.ToLevelZero(position, level_);
}

// Corners on straight edges are left out, unless the others are fewer than half of the features
// that the level should have: where there is little else, they are better than nothing.
void LevelExtractor::Select(const cv::Mat& image) {
  if (keep_edges_) {
    selection_.Select(corners_, image.size(), quota_, selected_);
    return;
  }
  const auto firm =
      std::stable_partition(corners_.begin(), corners_.end(), [&](const Corner& corner) {
        return !IsStraightEdge(image, {corner.x, corner.y});
      });
  on_edges_.assign(firm, corners_.end());
  corners_.erase(firm, corners_.end());
  selection_.Select(corners_, image.size(), quota_, selected_);
  const size_t least = quota_ / 2;
  if (selected_.size() < least && !on_edges_.empty()) {
    std::vector<Corner> more;
    selection_.Select(on_edges_, image.size(), least - selected_.size(), more);
    selected_.insert(selected_.end(), more.begin(), more.end());
  }
}

void LevelExtractor::Describe(const Corner& corner, const ImagePyramid& pyramid,
                              const cv::Mat& blurred) {
  const cv::Point center(corner.x, corner.y);
  const Orientation orientation = ComputeOrientation(pyramid.level(level_), center);
  RawKeypoint keypoint;
  keypoint.raw = PositionOf(corner, pyramid);
  keypoint.angle = orientation.Angle();
  keypoint.response = corner.score;
  keypoint.level = level_;
  features_.keypoints.push_back(keypoint);
  features_.descriptors.push_back(ComputeDescriptor(blurred, center, orientation));
}

// The features of all levels, in the order of the levels.
ExtractedFeatures Join(const std::vector<LevelExtractor>& levels) {
  size_t count = 0;
  for (const LevelExtractor& level : levels) {
    count += level.features().keypoints.size();
  }
  ExtractedFeatures all;
  all.keypoints.reserve(count);
  all.descriptors.reserve(count);
  for (const LevelExtractor& level : levels) {
    const auto& [keypoints, descriptors] = level.features();
    all.keypoints.insert(all.keypoints.end(), keypoints.begin(), keypoints.end());
    all.descriptors.insert(all.descriptors.end(), descriptors.begin(), descriptors.end());
  }
  return all;
}

void CheckImage(const cv::Mat& grey, const cv::Mat& ignored) {
  Check(grey.type() == CV_8UC1, "the image is not CV_8UC1");
  Check(ignored.empty() || (ignored.type() == CV_8UC1 && ignored.size() == grey.size()),
        "the mask is not CV_8UC1 of the size of the image");
  Check(std::min(grey.cols, grey.rows) >= FeatureOptions::kSmallestSide,
        "the image is smaller than 64 x 64 px");
}

}  // namespace

bool IsIgnored(const cv::Mat& ignored, const Eigen::Vector2f& raw) {
  const cv::Point pixel(cvRound(raw.x()), cvRound(raw.y()));
  return cv::Rect({}, ignored.size()).contains(pixel) && ignored.at<unsigned char>(pixel) != 0;
}

struct FeatureExtractor::Impl {
  Impl(const FeatureOptions& options, bool halves_levels)
      : levels(ScaleLevels::Create(options.level_count, options.scale_factor)), pyramid(levels) {
    const std::vector<size_t> quotas = LevelQuotas(options, halves_levels);
    for (size_t l = 0; l < quotas.size(); l += halves_levels ? 2 : 1) {
      extractors.emplace_back(options, static_cast<int>(l), quotas[l]);
    }
  }

  ScaleLevels levels;
  ImagePyramid pyramid;
  std::vector<LevelExtractor> extractors;  // one per level that has features
};

FeatureExtractor::FeatureExtractor(const FeatureOptions& options, bool halves_levels)
    : impl_(std::make_unique<Impl>(options, halves_levels)) {}
FeatureExtractor::~FeatureExtractor() = default;
FeatureExtractor::FeatureExtractor(FeatureExtractor&&) noexcept = default;
FeatureExtractor& FeatureExtractor::operator=(FeatureExtractor&&) noexcept = default;

const ScaleLevels& FeatureExtractor::levels() const { return impl_->levels; }

const ImagePyramid& FeatureExtractor::pyramid() const { return impl_->pyramid; }

ExtractedFeatures FeatureExtractor::Extract(const cv::Mat& grey) {
  SerialRunner runner;
  return Extract(grey, runner);
}

ExtractedFeatures FeatureExtractor::Extract(const cv::Mat& grey, TaskRunner& runner,
                                            const cv::Mat& ignored) {
  CheckImage(grey, ignored);
  impl_->pyramid.Build(grey);
  // The largest level comes first, so that all threads end at about the same time.
  runner.Run(impl_->extractors.size(),
             [&](size_t l) { impl_->extractors[l].Extract(impl_->pyramid, ignored); });
  return Join(impl_->extractors);
}

std::array<ExtractedFeatures, 2> FeatureExtractor::ExtractPair(
    const std::array<FeatureExtractor*, 2>& extractors, const std::array<cv::Mat, 2>& images,
    TaskRunner& runner, const std::array<cv::Mat, 2>& ignored) {
  for (size_t i = 0; i < images.size(); ++i) {
    CheckImage(images[i], ignored[i]);
  }
  runner.Run(2, [&](size_t i) { extractors[i]->impl_->pyramid.Build(images[i]); });
  const std::array<size_t, 2> levels{extractors[0]->impl_->extractors.size(),
                                     extractors[1]->impl_->extractors.size()};
  runner.Run(2 * std::max(levels[0], levels[1]), [&](size_t task) {
    const size_t i = task % 2;
    if (const size_t l = task / 2; l < levels[i]) {
      Impl& impl = *extractors[i]->impl_;
      impl.extractors[l].Extract(impl.pyramid, ignored[i]);
    }
  });
  return {Join(extractors[0]->impl_->extractors), Join(extractors[1]->impl_->extractors)};
}

}  // namespace hullslam

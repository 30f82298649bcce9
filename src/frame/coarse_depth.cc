// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/coarse_depth.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace hullslam {
namespace {

constexpr double kNearest = 4.0;  // baselines
constexpr int kBlock = 5;         // px; side of the compared blocks
// Penalties of Hirschmüller for disparities of neighbours that differ by one and by more, per pixel
// of a block; the factors are those that OpenCV's documentation recommends.
constexpr int kSmallStep = 8 * kBlock * kBlock;
constexpr int kLargeStep = 32 * kBlock * kBlock;

// The number of disparities that must be tried in the images of half the size; a multiple of 16, as
// OpenCV wants. One in a hundred keypoints may be matched wrongly, and an object without keypoints
// may be nearer than those, by a quarter. With few keypoints, all distances are tried.
int DisparityCount(const PinholeCamera& camera, std::span<const float> disparities) {
  constexpr size_t kFew = 50;
  constexpr double kNearer = 1.25;
  double largest = camera.fx / kNearest;
  std::vector<float> known;
  std::ranges::copy_if(disparities, std::back_inserter(known), [](float d) { return d > 0.0F; });
  if (known.size() >= kFew) {
    const auto last = known.end() - 1 - static_cast<std::ptrdiff_t>(known.size() / 100);
    std::nth_element(known.begin(), last, known.end());
    largest = std::min(largest, kNearer * static_cast<double>(*last));
  }
  return 16 * std::max(1, static_cast<int>(std::ceil(0.5 * largest / 16.0)));
}

cv::Mat HalfSize(const cv::Mat& image) {
  cv::Mat half;
  cv::resize(image, half, {}, 0.5, 0.5, cv::INTER_AREA);
  return half;
}

// The part of the images of half the size that is needed for the region: disparities are found from
// the column `count` on.
cv::Rect PartOf(const cv::Rect& region, int count, const cv::Size& half) {
  const int left = std::max(0, region.x / 2 - count);
  const int top = region.y / 2;
  return cv::Rect(left, top, (region.br().x + 1) / 2 - left, (region.br().y + 1) / 2 - top) &
         cv::Rect({0, 0}, half);
}

// The rows `first` to `last` - 1 of the part.
struct Band {
  int first = 0;
  int last = 0;
};

class CoarseMatcher {
 public:
  CoarseMatcher(const cv::Mat& left, const cv::Mat& right, const PinholeCamera& camera,
                const CoarseDepthPlace& place)
      : left_(HalfSize(left)),
        right_(HalfSize(right)),
        bf_(camera.bf),
        scale_(static_cast<double>(left.cols) / static_cast<double>(left_.cols) / kPerPixel),
        region_(place.region),
        count_(DisparityCount(camera, place.disparities)),
        part_(PartOf(place.region, count_, left_.size())) {}

  // The bands can be matched in any order. Their number does not depend on the number of threads.
  std::vector<Band> Bands() const {
    if (part_.width <= count_ || part_.height < kBlock) {
      return {};
    }
    const int half = part_.height < 2 * kLeastBand ? part_.height : part_.height / 2;
    std::vector<Band> bands{{0, half}};
    if (half < part_.height) {
      bands.push_back({half, part_.height});
    }
    return bands;
  }

  void Match(const Band& band, cv::Mat& depth) const {
    const int begin = std::max(0, band.first - kOverlap);
    const int end = std::min(part_.height, band.last + kBlock / 2);
    const cv::Rect rows(part_.x, part_.y + begin, part_.width, end - begin);
    // OpenCV's modes with threads of their own wait for cores that others use.
    const auto matcher = cv::StereoSGBM::create(0, count_, kBlock, kSmallStep, kLargeStep, 1, 31,
                                                10, 60, 2, cv::StereoSGBM::MODE_SGBM);
    cv::Mat disparities;
    matcher->compute(left_(rows), right_(rows), disparities);
    const int last_row = left_.rows - 1;
    for (int y = region_.y; y < region_.br().y; ++y) {
      const int row = std::min(y / 2, last_row) - part_.y;
      if (row < band.first || row >= band.last) {
        continue;
      }
      const auto* const found = disparities.ptr<int16_t>(row - begin);
      for (int x = region_.x; x < region_.br().x; ++x) {
        const int disparity = found[std::min(x / 2, part_.br().x - 1) - part_.x];
        depth.at<float>(y, x) =
            disparity > 0 ? static_cast<float>(bf_ / (scale_ * disparity)) : 0.0F;
      }
    }
  }

 private:
  static constexpr double kPerPixel = 16.0;  // units of OpenCV's disparities
  static constexpr int kLeastBand = 32;      // rows of half the size
  // Rows above a band from which the costs of its first row are gathered. The penalties let a row
  // depend on few rows above it.
  static constexpr int kOverlap = 8;

  cv::Mat left_;  // of half the size
  cv::Mat right_;
  double bf_;
  double scale_;  // px of the left image per unit of OpenCV's disparities
  cv::Rect region_;
  int count_;      // disparities
  cv::Rect part_;  // of the images of half the size
};

}  // namespace

cv::Mat CoarseDepth(const cv::Mat& left, const cv::Mat& right, const PinholeCamera& camera,
                    const CoarseDepthPlace& place, TaskRunner& runner) {
  cv::Mat depth = cv::Mat::zeros(left.size(), CV_32FC1);
  const CoarseMatcher matcher(left, right, camera, place);
  const std::vector<Band> bands = matcher.Bands();
  runner.Run(bands.size(), [&](size_t i) { matcher.Match(bands[i], depth); });
  return depth;
}

}  // namespace hullslam

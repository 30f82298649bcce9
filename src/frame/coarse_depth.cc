// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/coarse_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace hullslam {
namespace {

constexpr double kNearest = 4.0;  // baselines
// The images are compared in half of their columns, which measure depths, and a quarter of their
// rows.
constexpr int kShrinkX = 2;
constexpr int kShrinkY = 4;
constexpr int kBlock = 3;     // px; side of the compared blocks
constexpr int kSpeckle = 30;  // px; smaller spots of other disparities are left out
// Penalties of Hirschmüller for disparities of neighbours that differ by one and by more, per pixel
// of a block; the factors are those that OpenCV's documentation recommends.
constexpr int kSmallStep = 8 * kBlock * kBlock;
constexpr int kLargeStep = 32 * kBlock * kBlock;

// The number of disparities that must be tried in the smaller images; a multiple of 16, as
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
  return 16 * std::max(1, static_cast<int>(std::ceil(largest / (16.0 * kShrinkX))));
}

cv::Mat Shrunk(const cv::Mat& image) {
  cv::Mat shrunk;
  cv::resize(image, shrunk, {image.cols / kShrinkX, image.rows / kShrinkY}, 0, 0, cv::INTER_AREA);
  return shrunk;
}

// The part of the smaller images that is needed for the region: disparities are found from the
// column `count` on.
cv::Rect PartOf(const cv::Rect& region, int count, const cv::Size& size) {
  const int left = std::max(0, region.x / kShrinkX - count);
  const cv::Point end((region.br().x - 1) / kShrinkX + 1, (region.br().y - 1) / kShrinkY + 1);
  return cv::Rect({left, region.y / kShrinkY}, end) & cv::Rect({0, 0}, size);
}

// The rows `first` to `last` - 1 of the part.
struct Band {
  int first = 0;
  int last = 0;
};

class CoarseMatcher {
 public:
  // Both images are the smaller ones.
  CoarseMatcher(const cv::Mat& left, const cv::Mat& right, const PinholeCamera& camera,
                const CoarseDepthPlace& place)
      : left_(left),
        right_(right),
        bf_(camera.bf),
        scale_(static_cast<double>(camera.width) / static_cast<double>(left.cols) / kPerPixel),
        region_(place.region),
        count_(DisparityCount(camera, place.disparities)),
        part_(PartOf(place.region, count_, left_.size())) {}

  // The bands can be matched in any order. Their number does not depend on the number of threads.
  std::vector<Band> Bands() const {
    if (part_.width <= count_ || part_.height < kBlock) {
      return {};
    }
    const int half = part_.height / 2;
    return half < kLeastBand ? std::vector<Band>{{0, part_.height}}
                             : std::vector<Band>{{0, half}, {half, part_.height}};
  }

  void Match(const Band& band, cv::Mat& depth) const {
    const int begin = std::max(0, band.first - kOverlap);
    const int end = std::min(part_.height, band.last + kBlock / 2);
    const cv::Rect rows(part_.x, part_.y + begin, part_.width, end - begin);
    // OpenCV's modes with threads of their own wait for cores that others use.
    const auto matcher = cv::StereoSGBM::create(0, count_, kBlock, kSmallStep, kLargeStep, 1, 31,
                                                10, kSpeckle, 2, cv::StereoSGBM::MODE_SGBM);
    cv::Mat disparities;
    matcher->compute(left_(rows), right_(rows), disparities);
    const cv::Range columns(region_.x, region_.br().x);
    int last = -1;
    for (int y = region_.y; y < region_.br().y; ++y) {
      const int row = std::min(y / kShrinkY, left_.rows - 1) - part_.y;
      if (row < band.first || row >= band.last) {
        continue;
      }
      const auto* const found = disparities.ptr<int16_t>(row - begin);
      if (std::exchange(last, row) == row) {
        depth(cv::Range(y - 1, y), columns).copyTo(depth(cv::Range(y, y + 1), columns));
        continue;
      }
      for (int x = columns.start; x < columns.end; ++x) {
        const int disparity = found[std::min(x / kShrinkX, part_.br().x - 1) - part_.x];
        depth.at<float>(y, x) =
            disparity > 0 ? static_cast<float>(bf_ / (scale_ * disparity)) : 0.0F;
      }
    }
  }

 private:
  static constexpr double kPerPixel = 16.0;  // units of OpenCV's disparities
  static constexpr int kLeastBand = 16;      // rows of the smaller images
  // Rows above a band from which the costs of its first row are gathered. The penalties let a row
  // depend on few rows above it.
  static constexpr int kOverlap = 4;

  cv::Mat left_;  // the smaller images
  cv::Mat right_;
  double bf_;
  double scale_;  // px of the left image per unit of OpenCV's disparities
  cv::Rect region_;
  int count_;      // disparities
  cv::Rect part_;  // of the smaller images
};

}  // namespace

cv::Mat CoarseDepth(const cv::Mat& left, const cv::Mat& right, const PinholeCamera& camera,
                    const CoarseDepthPlace& place, TaskRunner& runner) {
  cv::Mat depth = cv::Mat::zeros(left.size(), CV_32FC1);
  std::array<cv::Mat, 2> smaller;
  runner.Run(2, [&](size_t i) { smaller[i] = Shrunk(i == 0 ? left : right); });
  const CoarseMatcher matcher(smaller[0], smaller[1], camera, place);
  const std::vector<Band> bands = matcher.Bands();
  runner.Run(bands.size(), [&](size_t i) { matcher.Match(bands[i], depth); });
  return depth;
}

}  // namespace hullslam

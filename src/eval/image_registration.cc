// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/image_registration.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "camera/fit_depth.h"
#include "hullslam/util/check.h"

namespace hullslam {

cv::Mat RelativeGradientVectors(const cv::Mat& grey) {
  constexpr double kMost = 200.0;
  std::vector<cv::Mat> parts(2);
  cv::Sobel(grey, parts[0], CV_32F, 1, 0);
  cv::Sobel(grey, parts[1], CV_32F, 0, 1);
  cv::Mat length;
  cv::magnitude(parts[0], parts[1], length);
  cv::Mat factor;
  cv::divide(kMost, cv::max(length, kMost), factor);
  const double mean = cv::mean(cv::min(length, kMost))[0];
  for (cv::Mat& part : parts) {
    part = part.mul(factor, mean > 0.0 ? 1.0 / mean : 1.0);
  }
  cv::Mat gradient;
  cv::merge(parts, gradient);
  return gradient;
}

cv::Mat RelativeGradient(const cv::Mat& grey) {
  std::vector<cv::Mat> parts;
  cv::split(RelativeGradientVectors(grey), parts);
  cv::Mat length;
  cv::magnitude(parts[0], parts[1], length);
  return length;
}

namespace {

constexpr int kOrientations = 8;

// The position in the stored image, in shares of its size, of (u, v) in the turned image.
Eigen::Vector2d StoredPosition(int orientation, double u, double v) {
  switch (orientation) {
    case 2:
      return {1.0 - u, v};
    case 3:
      return {1.0 - u, 1.0 - v};
    case 4:
      return {u, 1.0 - v};
    case 5:
      return {v, u};
    case 6:
      return {v, 1.0 - u};
    case 7:
      return {1.0 - v, 1.0 - u};
    case 8:
      return {1.0 - v, u};
    default:
      return {u, v};
  }
}

}  // namespace

void MaskRegistration::Add(const cv::Mat& grey, std::span<const InstanceMask> masks) {
  Check(grey.type() == CV_8UC1, "the image is not grey");
  const cv::Mat gradient = RelativeGradient(grey);
  const auto add_point = [&](const Eigen::Vector2d& point) {
    const double u = (point.x() + 0.5) / grey.cols;
    const double v = (point.y() + 0.5) / grey.rows;
    for (int orientation = 1; orientation <= kOrientations; ++orientation) {
      const Eigen::Vector2d place = StoredPosition(orientation, u, v);
      const int x = std::clamp(static_cast<int>(place.x() * grey.cols), 0, grey.cols - 1);
      const int y = std::clamp(static_cast<int>(place.y() * grey.rows), 0, grey.rows - 1);
      gradients_[static_cast<size_t>(orientation)] += gradient.at<float>(y, x);
    }
    ++points_;
  };
  for (const InstanceMask& mask : masks) {
    if (mask.shape != MaskShape::kContour || mask.outlines.empty()) {
      continue;
    }
    const std::vector<Eigen::Vector2d>& outline = mask.outlines.front();
    for (size_t i = 0; i < outline.size(); ++i) {
      const Eigen::Vector2d step = outline[(i + 1) % outline.size()] - outline[i];
      const int count = std::max(1, static_cast<int>(step.norm()));
      for (int k = 0; k < count; ++k) {
        add_point(outline[i] + step * k / count);
      }
    }
  }
}

double MaskRegistration::Contrast(int orientation) const {
  Check(points_ > 0, "there are no contours");
  Check(orientation >= 1 && orientation <= kOrientations, "not an orientation of EXIF");
  return gradients_[static_cast<size_t>(orientation)] / static_cast<double>(points_);
}

namespace {

constexpr int kShifts = 25;  // per direction; an odd number, so that no shift is the middle one

// A pixel on the near side of a step of the depth.
struct Step {
  cv::Point pixel;
  cv::Vec2f across;  // unit vector
};

// Unit vectors in the direction in which the depth changes, CV_32FC2. `depth` is 0 where it is not
// known, and counts as `farthest` there.
cv::Mat DirectionsOf(const cv::Mat& depth, const cv::Mat& farthest) {
  constexpr double kSigma = 1.5;  // px
  cv::Mat filled = depth.clone();
  farthest.copyTo(filled, depth <= 0.0);
  cv::log(cv::max(filled, 1e-6), filled);
  cv::GaussianBlur(filled, filled, cv::Size(), kSigma);
  std::vector<cv::Mat> parts(2);
  cv::Sobel(filled, parts[0], CV_32F, 1, 0);
  cv::Sobel(filled, parts[1], CV_32F, 0, 1);
  cv::Mat length;
  cv::magnitude(parts[0], parts[1], length);
  for (cv::Mat& part : parts) {
    cv::divide(part, cv::max(length, 1e-9), part);
  }
  cv::Mat directions;
  cv::merge(parts, directions);
  return directions;
}

// Something at most two pixels away is farther by a tenth, and nothing there is nearer.
std::vector<Step> FindSteps(const cv::Mat& depth, const cv::Rect& inside) {
  constexpr float kFarther = 1.1f;
  constexpr float kNearer = 0.97f;
  constexpr float kUnknown = 1e9f;
  cv::Mat known;
  depth.convertTo(known, CV_32F);
  cv::patchNaNs(known, 0.0);
  cv::Mat nearest;
  cv::Mat farthest;
  const cv::Mat window = cv::Mat::ones(5, 5, CV_8UC1);
  cv::dilate(known, farthest, window);
  cv::Mat without_holes = known.clone();
  without_holes.setTo(kUnknown, known <= 0.0);
  cv::erode(without_holes, nearest, window);
  const cv::Mat directions = DirectionsOf(known, farthest);
  std::vector<Step> steps;
  for (int y = inside.y; y < inside.br().y; ++y) {
    for (int x = inside.x; x < inside.br().x; ++x) {
      const float z = known.at<float>(y, x);
      if (z > 0.0f && z < kUnknown && farthest.at<float>(y, x) > kFarther * z &&
          nearest.at<float>(y, x) > kNearer * z) {
        steps.push_back({{x, y}, directions.at<cv::Vec2f>(y, x)});
      }
    }
  }
  return steps;
}

// The size at which two images of these sizes are compared.
cv::Size CommonSize(const cv::Size& grey, const cv::Size& depth) {
  constexpr double kMostPixels = 640.0 * 480.0;
  const cv::Size smaller = depth.width < grey.width ? depth : grey;
  const double scale = std::min(1.0, std::sqrt(kMostPixels / smaller.area()));
  return {static_cast<int>(std::lround(scale * smaller.width)),
          static_cast<int>(std::lround(scale * smaller.height))};
}

cv::Mat Resized(const cv::Mat& image, const cv::Size& size, int interpolation) {
  if (image.size() == size) {
    return image;
  }
  cv::Mat resized;
  cv::resize(image, resized, size, 0.0, 0.0, interpolation);
  return resized;
}

}  // namespace

void DepthRegistration::Add(const cv::Mat& full_grey, const cv::Mat& full_depth) {
  Check(full_grey.type() == CV_8UC1 && HaveSameShape(full_depth.size(), full_grey.size()),
        "the two images do not fit");
  const cv::Size size = CommonSize(full_grey.size(), full_depth.size());
  const cv::Mat grey = Resized(full_grey, size, cv::INTER_AREA);
  const cv::Mat depth = Resized(full_depth, size, cv::INTER_NEAREST);
  constexpr int kShare = 160;  // the shifts are multiples of this share of the image
  constexpr int kHalf = kShifts / 2;
  const cv::Point unit(std::max(1, grey.cols / kShare), std::max(1, grey.rows / kShare));
  const cv::Point margin = kHalf * unit;
  const cv::Rect inside(margin.x, margin.y, std::max(0, grey.cols - 2 * margin.x),
                        std::max(0, grey.rows - 2 * margin.y));
  const cv::Mat gradient = RelativeGradientVectors(grey);
  const std::vector<Step> steps = FindSteps(depth, inside);
  edges_ += steps.size();
  gradients_.resize(static_cast<size_t>(kShifts) * kShifts);
  for (int row = 0; row < kShifts; ++row) {
    for (int column = 0; column < kShifts; ++column) {
      const cv::Point shift((column - kHalf) * unit.x, (row - kHalf) * unit.y);
      double& sum = gradients_[static_cast<size_t>(row * kShifts + column)];
      for (const Step& step : steps) {
        sum += std::abs(step.across.dot(gradient.at<cv::Vec2f>(step.pixel + shift)));
      }
    }
  }
}

double DepthRegistration::Contrast() const { return LargestWithin(0, 1); }

double DepthRegistration::ContrastElsewhere() const { return LargestWithin(3, kShifts); }

double DepthRegistration::LargestWithin(int from, int to) const {
  Check(edges_ > 0, "there are no steps of the depth");
  const double mean = std::accumulate(gradients_.begin(), gradients_.end(), 0.0) /
                      static_cast<double>(gradients_.size());
  double largest = 0.0;
  for (int row = 0; row < kShifts; ++row) {
    for (int column = 0; column < kShifts; ++column) {
      const int distance = std::max(std::abs(row - kShifts / 2), std::abs(column - kShifts / 2));
      if (distance >= from && distance <= to) {
        largest = std::max(largest, gradients_[static_cast<size_t>(row * kShifts + column)]);
      }
    }
  }
  return mean > 0.0 ? largest / mean : 1.0;
}

}  // namespace hullslam

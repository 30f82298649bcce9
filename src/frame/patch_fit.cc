// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/patch_fit.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace hullslam {
namespace {

constexpr int kHalf = 5;  // px; a patch has 11 x 11
constexpr int kSide = 2 * kHalf + 1;
constexpr int kReach = 5;  // px; columns to each side in which the patch is shifted
constexpr int kShifts = 2 * kReach + 1;

// The pixels of a patch, row by row.
using Patch = std::array<float, size_t{kSide} * kSide>;

// Whether the patch lies in the image with so many pixels about it.
bool IsInside(const cv::Mat& image, int x, int y, int about = 0) {
  const int reach = kHalf + about;
  return x >= reach && y >= reach && x + reach < image.cols && y + reach < image.rows;
}

// The patch about a pixel that IsInside.
Patch CutPatch(const cv::Mat& image, int x, int y) {
  Patch patch;
  size_t i = 0;
  for (int row = y - kHalf; row <= y + kHalf; ++row) {
    const uint8_t* const pixels = image.ptr<uint8_t>(row) + x - kHalf;
    for (int column = 0; column < kSide; ++column) {
      patch[i++] = static_cast<float>(pixels[column]);
    }
  }
  return patch;
}

// The patch less its mean, so that images of different brightness can be compared.
Patch LessMean(Patch patch) {
  float sum = 0.0F;
  for (const float value : patch) {
    sum += value;
  }
  const float mean = sum / static_cast<float>(patch.size());
  for (float& value : patch) {
    value -= mean;
  }
  return patch;
}

// Gaussian weights about the middle, whose mean is 1. Beside a corner at the side of an object the
// patch shows the background, whose disparity is smaller; so the weights fall to 1/e at its rim.
Patch MakeCentreWeights() {
  Patch weights;
  float sum = 0.0F;
  for (int i = 0; i < kSide * kSide; ++i) {
    const auto x = static_cast<float>(i % kSide - kHalf);
    const auto y = static_cast<float>(i / kSide - kHalf);
    weights[static_cast<size_t>(i)] = std::exp(-(x * x + y * y) / (kHalf * kHalf));
    sum += weights[static_cast<size_t>(i)];
  }
  for (float& weight : weights) {
    weight *= static_cast<float>(weights.size()) / sum;
  }
  return weights;
}

const Patch& CentreWeights() {
  static const Patch weights = MakeCentreWeights();
  return weights;
}

// ---- whole pixels

// One number per shift of the patch. The last ones are not used; they let a compiler work on eight
// at a time.
using PerShift = std::array<float, 16>;
static_assert(kShifts <= PerShift().size());

// The pixels that the shifted patches cover, and columns for the numbers that are not used.
class Strip {
 public:
  static constexpr size_t kWidth = static_cast<size_t>(kSide) - 1 + PerShift().size();

  // Beyond the sides of the image the pixels are 0. The rows must lie in it.
  Strip(const cv::Mat& image, int x, int y) {
    const int left = x - kHalf - kReach;
    const int first = std::max(0, -left);
    const int last = std::min(static_cast<int>(kWidth), image.cols - left);
    for (int row = 0; row < kSide; ++row) {
      const uint8_t* const pixels = image.ptr<uint8_t>(y - kHalf + row);
      for (int column = first; column < last; ++column) {
        pixels_[static_cast<size_t>(row) * kWidth + static_cast<size_t>(column)] =
            static_cast<float>(pixels[left + column]);
      }
    }
  }

  // The weighted mean absolute difference of the patch, less its mean, from each of those in the
  // strip, less their means.
  PerShift Differences(const Patch& patch) const {
    const PerShift means = Means();
    PerShift sums{};
    const Patch& weights = CentreWeights();
    ForEachPixel([&](size_t i, const float* pixels) {
      for (size_t shift = 0; shift < sums.size(); ++shift) {
        sums[shift] += weights[i] * std::abs(patch[i] - (pixels[shift] - means[shift]));
      }
    });
    for (float& sum : sums) {
      sum /= static_cast<float>(patch.size());
    }
    return sums;
  }

 private:
  // Calls visit(i, pixels) for each pixel i of a patch; pixels[k] is the one of the k-th shift.
  template <typename Visit>
  void ForEachPixel(const Visit& visit) const {
    for (size_t row = 0; row < size_t{kSide}; ++row) {
      for (size_t column = 0; column < size_t{kSide}; ++column) {
        visit(row * kSide + column, &pixels_[row * kWidth + column]);
      }
    }
  }

  PerShift Means() const {
    PerShift sums{};
    ForEachPixel([&](size_t /*i*/, const float* pixels) {
      for (size_t shift = 0; shift < sums.size(); ++shift) {
        sums[shift] += pixels[shift];
      }
    });
    for (float& sum : sums) {
      sum /= static_cast<float>(kSide * kSide);
    }
    return sums;
  }

  std::array<float, size_t{kSide} * kWidth> pixels_{};
};

struct Shift {
  int column = 0;
  float difference = 0.0F;
};

// The column at which the patch fits best; nothing if that is the last one that was tried. The row
// must have room for a patch.
std::optional<Shift> FindShift(const Patch& patch, const cv::Mat& image, int column, int row) {
  PerShift differences = Strip(image, column, row).Differences(LessMean(patch));
  for (int shift = 0; shift < kShifts; ++shift) {
    if (!IsInside(image, column - kReach + shift, row)) {
      differences[static_cast<size_t>(shift)] = std::numeric_limits<float>::infinity();
    }
  }
  const auto best = std::min_element(differences.begin(), differences.begin() + kShifts);
  const auto at = static_cast<int>(best - differences.begin());
  if (at == 0 || at == kShifts - 1 || !std::isfinite(*(best - 1)) || !std::isfinite(*(best + 1))) {
    return std::nullopt;
  }
  return Shift{column + at - kReach, *best};
}

// ---- fractions of a pixel

constexpr int kMargin =
    4;  // px about the patch: it moves by less than two, and two are interpolated from

using CubicWeights = std::array<float, 4>;

// The weights of the four pixels around a point between the second and the third of them, `share`
// of the way (Keys 1981, a = -1/2). Linear weights would blur the image between its pixels.
CubicWeights CubicWeightsAt(float share) {
  const float t = share;
  return {((-0.5F * t + 1.0F) * t - 0.5F) * t, (1.5F * t - 2.5F) * t * t + 1.0F,
          ((-1.5F * t + 2.0F) * t + 0.5F) * t, (0.5F * t - 0.5F) * t * t};
}

// The patch about a point of a row between its pixels. It is inside with two pixels about it.
Patch Interpolate(const cv::Mat& image, float x, int y) {
  const int left = static_cast<int>(std::floor(x));
  const CubicWeights across = CubicWeightsAt(x - static_cast<float>(left));
  Patch patch;
  size_t next = 0;
  for (int row = y - kHalf; row <= y + kHalf; ++row) {
    const uint8_t* const pixels = image.ptr<uint8_t>(row) + left - kHalf - 1;
    for (int i = 0; i < kSide; ++i) {
      patch[next++] = across[0] * static_cast<float>(pixels[i]) +
                      across[1] * static_cast<float>(pixels[i + 1]) +
                      across[2] * static_cast<float>(pixels[i + 2]) +
                      across[3] * static_cast<float>(pixels[i + 3]);
    }
  }
  return patch;
}

// The problem of least squares with the unknowns column, gain and offset. Its derivatives are those
// of the left patch, which do not change (Baker and Matthews 2004): where the sum of derivative
// times difference vanishes, the patches fit, whatever the noise of the derivatives is.
class Refinement {
 public:
  Refinement(const cv::Mat& left, cv::Point at) : patch_(CutPatch(left, at.x, at.y)) {
    const Patch& weights = CentreWeights();
    Eigen::Matrix3f hessian = Eigen::Matrix3f::Zero();
    size_t i = 0;
    for (int y = at.y - kHalf; y <= at.y + kHalf; ++y) {
      const auto* const row = left.ptr<uint8_t>(y);
      for (int x = at.x - kHalf; x <= at.x + kHalf; ++x) {
        by_column_[i] = 0.5F * static_cast<float>(row[x + 1] - row[x - 1]);
        const Eigen::Vector3f derivative(by_column_[i], -patch_[i], -1.0F);
        hessian += weights[i] * derivative * derivative.transpose();
        ++i;
      }
    }
    hessian.diagonal().array() += 1e-3F;  // a patch without texture
    inverse_ = hessian.inverse();
  }

  // Nothing if the best column is not beside the shift.
  std::optional<PatchFit> Run(const cv::Mat& right, const Shift& begin, int row) const {
    constexpr int kMostSteps = 10;
    constexpr float kSmallStep = 0.005F;  // px
    constexpr float kMostMoved = 1.5F;    // px
    Eigen::Vector3f at(static_cast<float>(begin.column), 1.0F, 0.0F);
    for (int step = 0; step < kMostSteps; ++step) {
      const Eigen::Vector3f change = inverse_ * Gradient(right, at, row);
      at -= change;
      // The comparison is written so that NaN is refused.
      if (!(std::abs(at[0] - static_cast<float>(begin.column)) < kMostMoved)) {
        return std::nullopt;
      }
      if (std::abs(change[0]) < kSmallStep) {
        break;
      }
    }
    return PatchFit{.column = at[0], .difference = begin.difference};
  }

 private:
  Eigen::Vector3f Gradient(const cv::Mat& right, const Eigen::Vector3f& at, int row) const {
    const Patch seen = Interpolate(right, at[0], row);
    const Patch& weights = CentreWeights();
    Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
    for (size_t i = 0; i < seen.size(); ++i) {
      const float error = weights[i] * (seen[i] - at[1] * patch_[i] - at[2]);
      gradient += error * Eigen::Vector3f(by_column_[i], -patch_[i], -1.0F);
    }
    return gradient;
  }

  Patch patch_;
  Patch by_column_;
  Eigen::Matrix3f inverse_;
};

}  // namespace

std::optional<PatchFit> FitPatch(const cv::Mat& left, cv::Point at, const cv::Mat& right,
                                 int column) {
  if (!IsInside(left, at.x, at.y, 1) || !IsInside(right, column, at.y, 0)) {
    return std::nullopt;
  }
  const std::optional<Shift> shift = FindShift(CutPatch(left, at.x, at.y), right, column, at.y);
  if (!shift || !IsInside(right, shift->column, at.y, kMargin)) {
    return std::nullopt;
  }
  return Refinement(left, at).Run(right, *shift, at.y);
}

}  // namespace hullslam

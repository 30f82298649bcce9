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

#include "util/function_clones.h"

namespace hullslam {
namespace {

constexpr int kHalf = 5;  // px; a patch has 11 x 11
constexpr int kSide = 2 * kHalf + 1;
constexpr float kPixels = kSide * kSide;
constexpr int kBefore = 1;  // columns before a left patch, for its derivatives
constexpr int kReach = 5;   // px; columns to each side in which the patch is shifted
constexpr int kShifts = 2 * kReach + 1;

// Numbers in a row, one per column of a patch or per shift of it; the last ones are not used. They
// let a compiler work on eight at a time.
constexpr size_t kWidth = 16;
using Lanes = std::array<float, kWidth>;
static_assert(kShifts <= kWidth && kSide <= kWidth);

// One number per pixel of a patch, row by row.
using Patch = std::array<Lanes, kSide>;

// Whether the patch lies in the image with so many pixels about it.
bool IsInside(const cv::Mat& image, int x, int y, int about = 0) {
  const int reach = kHalf + about;
  return x >= reach && y >= reach && x + reach < image.cols && y + reach < image.rows;
}

// The order of the additions is that of a processor that adds several numbers at a time.
inline float Sum(Lanes values) {
  for (size_t half = kWidth / 2; half > 0; half /= 2) {
    for (size_t i = 0; i < half; ++i) {
      values[i] += values[i + half];
    }
  }
  return values[0];
}

// Gaussian weights about the middle, whose mean is 1. Beside a corner at the side of an object the
// patch shows the background, whose disparity is smaller; so the weights fall to 1/e at its rim.
const Patch& CentreWeights() {
  static const Patch weights = [] {
    Patch values{};
    float sum = 0.0F;
    for (int i = 0; i < kSide * kSide; ++i) {
      const auto x = static_cast<float>(i % kSide - kHalf);
      const auto y = static_cast<float>(i / kSide - kHalf);
      float& value = values[static_cast<size_t>(i / kSide)][static_cast<size_t>(i % kSide)];
      value = std::exp(-(x * x + y * y) / (kHalf * kHalf));
      sum += value;
    }
    for (Lanes& row : values) {
      std::ranges::transform(row, row.begin(), [&](float value) { return value * kPixels / sum; });
    }
    return values;
  }();
  return weights;
}

// ---- whole pixels

// The following functions round in the same way in both clones: AVX2 alone has no fused
// multiply-add, and the order of the additions is given.

// The pixels of a patch, of columns before it and of columns behind it.
using Strip = std::array<std::array<float, 2 * kWidth>, kSide>;

// Begins `about` columns before the patch about the pixel. Beyond the sides of the image the pixels
// are 0. The rows must lie in it.
HULLSLAM_FUNCTION_CLONES
Strip CutStrip(const cv::Mat& image, int x, int y, int about) {
  const int left = x - kHalf - about;
  const int first = std::max(0, -left);
  const int count = std::min(static_cast<int>(2 * kWidth), image.cols - left) - first;
  Strip strip;
  for (int row = 0; row < kSide; ++row) {
    std::array<uint8_t, 2 * kWidth> bytes{};
    std::copy_n(image.ptr<uint8_t>(y - kHalf + row) + left + first, count, bytes.begin() + first);
    std::ranges::copy(bytes, strip[static_cast<size_t>(row)].begin());
  }
  return strip;
}

// The weighted mean absolute difference of the patch, less its mean, from each of those in the
// strip, less their means, so that images of different brightness can be compared. Sums of pixels
// are whole numbers, so they are exact.
HULLSLAM_FUNCTION_CLONES
Lanes Differences(const Strip& left, const Strip& right, const Patch& weights) {
  std::array<float, 2 * kWidth> columns{};
  Lanes own{};
  for (size_t row = 0; row < kSide; ++row) {
    for (size_t i = 0; i < 2 * kWidth; ++i) {
      columns[i] += right[row][i];
    }
    for (size_t i = 0; i < kSide; ++i) {
      own[i] += left[row][i + kBefore];
    }
  }
  Lanes offsets{};
  for (size_t column = 0; column < kSide; ++column) {
    for (size_t shift = 0; shift < kWidth; ++shift) {
      offsets[shift] += columns[column + shift];
    }
  }
  const float own_mean = Sum(own) / kPixels;
  for (float& offset : offsets) {
    offset = offset / kPixels - own_mean;
  }
  Lanes sums{};
  for (size_t row = 0; row < kSide; ++row) {
    for (size_t column = 0; column < kSide; ++column) {
      for (size_t shift = 0; shift < kWidth; ++shift) {
        sums[shift] += weights[row][column] * std::abs(left[row][column + kBefore] +
                                                       offsets[shift] - right[row][column + shift]);
      }
    }
  }
  for (float& sum : sums) {
    sum /= kPixels;
  }
  return sums;
}

struct Shift {
  int column = 0;
  float difference = 0.0F;
};

// The column at which the patch fits best; nothing if that is the last one that was tried. The row
// must have room for a patch.
std::optional<Shift> FindShift(const Strip& left, const cv::Mat& image, int column, int row) {
  Lanes differences = Differences(left, CutStrip(image, column, row, kReach), CentreWeights());
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

// px about the patch: it moves by less than two, and two are interpolated from
constexpr int kMargin = 4;

using CubicWeights = std::array<float, 4>;

// The weights of the four pixels around a point between the second and the third of them, `share`
// of the way (Keys 1981, a = -1/2). Linear weights would blur the image between its pixels.
CubicWeights CubicWeightsAt(float share) {
  const float t = share;
  return {((-0.5F * t + 1.0F) * t - 0.5F) * t, (1.5F * t - 2.5F) * t * t + 1.0F,
          ((-1.5F * t + 2.0F) * t + 0.5F) * t, (0.5F * t - 0.5F) * t * t};
}

// The sums of weight d d, weight d p, weight p p, weight d and weight p, where d is the derivative
// by the column and p the pixel.
HULLSLAM_FUNCTION_CLONES
std::array<float, 5> SumSquares(const Strip& left, const Patch& weights) {
  std::array<Lanes, 5> sums{};
  for (size_t row = 0; row < kSide; ++row) {
    for (size_t i = 0; i < kWidth; ++i) {
      const float p = left[row][i + kBefore];
      const float d = 0.5F * (left[row][i + kBefore + 1] - left[row][i + kBefore - 1]);
      const float by_column = weights[row][i] * d;
      const float by_pixel = weights[row][i] * p;
      sums[0][i] += by_column * d;
      sums[1][i] += by_column * p;
      sums[2][i] += by_pixel * p;
      sums[3][i] += by_column;
      sums[4][i] += by_pixel;
    }
  }
  return {Sum(sums[0]), Sum(sums[1]), Sum(sums[2]), Sum(sums[3]), Sum(sums[4])};
}

// The sums of error d, error p and the weighted error, where the unknowns of Refinement are `at`.
HULLSLAM_FUNCTION_CLONES
std::array<float, 3> SumErrors(const Strip& left, const Strip& right, const Patch& weights,
                               const Eigen::Vector3f& at) {
  const float whole = std::floor(at[0]);
  const auto [w0, w1, w2, w3] = CubicWeightsAt(at[0] - whole);
  const auto begin = static_cast<size_t>(kMargin - 1 + static_cast<int>(whole));
  const float gain = at[1];
  const float offset = at[2];
  std::array<Lanes, 3> sums{};
  for (size_t row = 0; row < kSide; ++row) {
    const float* const pixels = &right[row][begin];
    for (size_t i = 0; i < kWidth; ++i) {
      const float p = left[row][i + kBefore];
      const float d = 0.5F * (left[row][i + kBefore + 1] - left[row][i + kBefore - 1]);
      const float seen =
          w0 * pixels[i] + w1 * pixels[i + 1] + w2 * pixels[i + 2] + w3 * pixels[i + 3];
      const float error = weights[row][i] * (seen - gain * p - offset);
      sums[0][i] += error * d;
      sums[1][i] += error * p;
      sums[2][i] += error;
    }
  }
  return {Sum(sums[0]), Sum(sums[1]), Sum(sums[2])};
}

// The problem of least squares with the unknowns column, gain and offset. Its derivatives are those
// of the left patch, which do not change (Baker and Matthews 2004): where the sum of derivative
// times difference vanishes, the patches fit, whatever the noise of the derivatives is.
class Refinement {
 public:
  explicit Refinement(const Strip& left) : left_(left) {
    const auto [dd, dp, pp, d, p] = SumSquares(left_, CentreWeights());
    Eigen::Matrix3f hessian;
    hessian << dd, -dp, -d, -dp, pp, p, -d, p, kPixels;
    hessian.diagonal().array() += 1e-3F;  // a patch without texture
    inverse_ = hessian.inverse();
  }

  // Nothing if the best column is not beside the shift.
  std::optional<PatchFit> Run(const cv::Mat& right, const Shift& begin, int row) const {
    constexpr int kMostSteps = 10;
    constexpr float kSmallStep = 0.005F;  // px
    constexpr float kMostMoved = 1.5F;    // px
    const Strip strip = CutStrip(right, begin.column, row, kMargin);
    Eigen::Vector3f at(0.0F, 1.0F, 0.0F);  // the column counts from that of the shift
    for (int step = 0; step < kMostSteps; ++step) {
      const auto [d, p, one] = SumErrors(left_, strip, CentreWeights(), at);
      const Eigen::Vector3f change = inverse_ * Eigen::Vector3f(d, -p, -one);
      at -= change;
      // The comparison is written so that NaN is refused.
      if (!(std::abs(at[0]) < kMostMoved)) {
        return std::nullopt;
      }
      if (std::abs(change[0]) < kSmallStep) {
        break;
      }
    }
    return PatchFit{.column = static_cast<float>(begin.column) + at[0],
                    .difference = begin.difference};
  }

 private:
  const Strip& left_;
  Eigen::Matrix3f inverse_;
};

}  // namespace

std::optional<PatchFit> FitPatch(const cv::Mat& left, cv::Point at, const cv::Mat& right,
                                 int column) {
  if (!IsInside(left, at.x, at.y, 1) || !IsInside(right, column, at.y, 0)) {
    return std::nullopt;
  }
  const Strip patch = CutStrip(left, at.x, at.y, kBefore);
  const std::optional<Shift> shift = FindShift(patch, right, column, at.y);
  if (!shift || !IsInside(right, shift->column, at.y, kMargin)) {
    return std::nullopt;
  }
  return Refinement(patch).Run(right, *shift, at.y);
}

}  // namespace hullslam

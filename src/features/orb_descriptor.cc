// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/orb_descriptor.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <numbers>

#include "features/orb_pattern.h"
#include "util/function_clones.h"

namespace hullslam {
namespace {

constexpr int kDiscRadius = 15;
constexpr int kDiscRows = 2 * kDiscRadius + 1;
constexpr int kDiscColumns = 32;  // one more than needed, to fill whole SIMD vectors

// Half width of the disc in each row from its centre, rounded as in the ORB of OpenCV: symmetric
// under swapping x and y.
constexpr std::array<int, kDiscRadius + 1> kDiscHalfWidth = {15, 15, 15, 15, 14, 14, 14, 13,
                                                             13, 12, 11, 10, 9,  8,  6,  3};

// For each pixel of the square around the disc its x from the centre, and 1. Both are 0 outside the
// disc.
struct DiscWeights {
  std::array<std::array<int16_t, kDiscColumns>, kDiscRows> x{};
  std::array<std::array<int16_t, kDiscColumns>, kDiscRows> one{};
};

constexpr DiscWeights MakeDiscWeights() {
  DiscWeights weights;
  for (int v = -kDiscRadius; v <= kDiscRadius; ++v) {
    const int half_width = kDiscHalfWidth[static_cast<size_t>(v < 0 ? -v : v)];
    for (int u = -half_width; u <= half_width; ++u) {
      const auto row = static_cast<size_t>(v + kDiscRadius);
      const auto column = static_cast<size_t>(u + kDiscRadius);
      weights.x[row][column] = static_cast<int16_t>(u);
      weights.one[row][column] = 1;
    }
  }
  return weights;
}

constexpr DiscWeights kDiscWeights = MakeDiscWeights();

struct Moments {
  int x = 0;
  int y = 0;
};

HULLSLAM_FUNCTION_CLONES
Moments DiscMoments(const uint8_t* center, ptrdiff_t step) {
  Moments moments;
  for (int v = -kDiscRadius; v <= kDiscRadius; ++v) {
    const uint8_t* row = center + v * step - kDiscRadius;
    const auto& x_weights = kDiscWeights.x[static_cast<size_t>(v + kDiscRadius)];
    const auto& one_weights = kDiscWeights.one[static_cast<size_t>(v + kDiscRadius)];
    int x_sum = 0;
    int sum = 0;
    for (size_t i = 0; i < kDiscColumns; ++i) {
      const auto value = static_cast<int16_t>(row[i]);
      x_sum += value * x_weights[i];
      sum += value * one_weights[i];
    }
    moments.x += x_sum;
    moments.y += v * sum;
  }
  return moments;
}

constexpr size_t kTests = kOrbPattern.size();

// The points of the tests as columns: first all first points, then all second points.
struct PatternColumns {
  std::array<float, 2 * kTests> x{};
  std::array<float, 2 * kTests> y{};
};

constexpr PatternColumns MakePatternColumns() {
  PatternColumns columns;
  for (size_t i = 0; i < kTests; ++i) {
    columns.x[i] = kOrbPattern[i].x1;
    columns.y[i] = kOrbPattern[i].y1;
    columns.x[kTests + i] = kOrbPattern[i].x2;
    columns.y[kTests + i] = kOrbPattern[i].y2;
  }
  return columns;
}

constexpr PatternColumns kPatternColumns = MakePatternColumns();

// Rounds to the nearest integer, ties to even, for |value| < 2^22. In the sum the last bit of the
// mantissa has the value 1. Unlike std::lrint, the compiler can vectorise this.
inline int32_t RoundSmall(float value) {
  constexpr float kShift = 12582912.0f;  // 1.5 * 2^23
  return std::bit_cast<int32_t>(value + kShift) - std::bit_cast<int32_t>(kShift);
}

using Offsets = std::array<int32_t, 2 * kTests>;

// Offsets in memory of the rotated points from the centre. AVX2 alone has no fused multiply-add, so
// both clones round in the same way.
HULLSLAM_FUNCTION_CLONES
void RotatePattern(const Orientation& orientation, int32_t step, Offsets& offsets) {
  const float cosine = orientation.cosine;
  const float sine = orientation.sine;
  for (size_t i = 0; i < offsets.size(); ++i) {
    const float x = kPatternColumns.x[i];
    const float y = kPatternColumns.y[i];
    offsets[i] = RoundSmall(x * sine + y * cosine) * step + RoundSmall(x * cosine - y * sine);
  }
}

}  // namespace

float Orientation::Angle() const {
  const float angle = std::atan2(sine, cosine);
  constexpr float kTurn = 2.0f * std::numbers::pi_v<float>;
  // A tiny negative angle plus a full turn would round to a full turn.
  return angle >= 0.0f ? angle : (angle + kTurn < kTurn ? angle + kTurn : 0.0f);
}

Orientation ComputeOrientation(const cv::Mat& image, cv::Point center) {
  const Moments moments =
      DiscMoments(image.ptr(center.y) + center.x, static_cast<ptrdiff_t>(image.step));
  if (moments.x == 0 && moments.y == 0) {
    return {};
  }
  // Cosine and sine are computed without trigonometric functions, whose last bit may depend on the
  // CPU.
  const double x = moments.x;
  const double y = moments.y;
  const double norm = std::sqrt(x * x + y * y);
  return {static_cast<float>(x / norm), static_cast<float>(y / norm)};
}

Descriptor ComputeDescriptor(const cv::Mat& blurred, cv::Point center,
                             const Orientation& orientation) {
  Offsets offsets;
  RotatePattern(orientation, static_cast<int32_t>(blurred.step), offsets);
  const uint8_t* const pixel = blurred.ptr(center.y) + center.x;
  Descriptor descriptor{};
  for (size_t i = 0; i < kTests; ++i) {
    const bool bit = pixel[offsets[i]] < pixel[offsets[kTests + i]];
    descriptor[i / 64] |= static_cast<uint64_t>(bit) << (i % 64);
  }
  return descriptor;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/orb_descriptor.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <numbers>

#include "util/function_clones.h"

namespace hullslam {
namespace {

struct BriefTest {
  int8_t x1, y1, x2, y2;  // px from the centre of the patch
};

// The 256 tests of ORB, learned from images of the PASCAL 2006 set for high variance and low
// correlation (Rublee, Rabaud, Konolige, Bradski: ORB, an efficient alternative to SIFT or SURF,
// ICCV 2011). The numbers are from OpenCV's ORB (`bit_pattern_31_`), which the vocabulary of
// ORB-SLAM2 uses too.
constexpr std::array<BriefTest, 256> kOrbPattern = {{
    {8, -3, 9, 5},       {4, 2, 7, -12},      {-11, 9, -8, 2},     {7, -12, 12, -13},
    {2, -13, 2, 12},     {1, -7, 1, 6},       {-2, -10, -2, -4},   {-13, -13, -11, -8},
    {-13, -3, -12, -9},  {10, 4, 11, 9},      {-13, -8, -8, -9},   {-11, 7, -9, 12},
    {7, 7, 12, 6},       {-4, -5, -3, 0},     {-13, 2, -12, -3},   {-9, 0, -7, 5},
    {12, -6, 12, -1},    {-3, 6, -2, 12},     {-6, -13, -4, -8},   {11, -13, 12, -8},
    {4, 7, 5, 1},        {5, -3, 10, -3},     {3, -7, 6, 12},      {-8, -7, -6, -2},
    {-2, 11, -1, -10},   {-13, 12, -8, 10},   {-7, 3, -5, -3},     {-4, 2, -3, 7},
    {-10, -12, -6, 11},  {5, -12, 6, -7},     {5, -6, 7, -1},      {1, 0, 4, -5},
    {9, 11, 11, -13},    {4, 7, 4, 12},       {2, -1, 4, 4},       {-4, -12, -2, 7},
    {-8, -5, -7, -10},   {4, 11, 9, 12},      {0, -8, 1, -13},     {-13, -2, -8, 2},
    {-3, -2, -2, 3},     {-6, 9, -4, -9},     {8, 12, 10, 7},      {0, 9, 1, 3},
    {7, -5, 11, -10},    {-13, -6, -11, 0},   {10, 7, 12, 1},      {-6, -3, -6, 12},
    {10, -9, 12, -4},    {-13, 8, -8, -12},   {-13, 0, -8, -4},    {3, 3, 7, 8},
    {5, 7, 10, -7},      {-1, 7, 1, -12},     {3, -10, 5, 6},      {2, -4, 3, -10},
    {-13, 0, -13, 5},    {-13, -7, -12, 12},  {-13, 3, -11, 8},    {-7, 12, -4, 7},
    {6, -10, 12, 8},     {-9, -1, -7, -6},    {-2, -5, 0, 12},     {-12, 5, -7, 5},
    {3, -10, 8, -13},    {-7, -7, -4, 5},     {-3, -2, -1, -7},    {2, 9, 5, -11},
    {-11, -13, -5, -13}, {-1, 6, 0, -1},      {5, -3, 5, 2},       {-4, -13, -4, 12},
    {-9, -6, -9, 6},     {-12, -10, -8, -4},  {10, 2, 12, -3},     {7, 12, 12, 12},
    {-7, -13, -6, 5},    {-4, 9, -3, 4},      {7, -1, 12, 2},      {-7, 6, -5, 1},
    {-13, 11, -12, 5},   {-3, 7, -2, -6},     {7, -8, 12, -7},     {-13, -7, -11, -12},
    {1, -3, 12, 12},     {2, -6, 3, 0},       {-4, 3, -2, -13},    {-1, -13, 1, 9},
    {7, 1, 8, -6},       {1, -1, 3, 12},      {9, 1, 12, 6},       {-1, -9, -1, 3},
    {-13, -13, -10, 5},  {7, 7, 10, 12},      {12, -5, 12, 9},     {6, 3, 7, 11},
    {5, -13, 6, 10},     {2, -12, 2, 3},      {3, 8, 4, -6},       {2, 6, 12, -13},
    {9, -12, 10, 3},     {-8, 4, -7, 9},      {-11, 12, -4, -6},   {1, 12, 2, -8},
    {6, -9, 7, -4},      {2, 3, 3, -2},       {6, 3, 11, 0},       {3, -3, 8, -8},
    {7, 8, 9, 3},        {-11, -5, -6, -4},   {-10, 11, -5, 10},   {-5, -8, -3, 12},
    {-10, 5, -9, 0},     {8, -1, 12, -6},     {4, -6, 6, -11},     {-10, 12, -8, 7},
    {4, -2, 6, 7},       {-2, 0, -2, 12},     {-5, -8, -5, 2},     {7, -6, 10, 12},
    {-9, -13, -8, -8},   {-5, -13, -5, -2},   {8, -8, 9, -13},     {-9, -11, -9, 0},
    {1, -8, 1, -2},      {7, -4, 9, 1},       {-2, 1, -1, -4},     {11, -6, 12, -11},
    {-12, -9, -6, 4},    {3, 7, 7, 12},       {5, 5, 10, 8},       {0, -4, 2, 8},
    {-9, 12, -5, -13},   {0, 7, 2, 12},       {-1, 2, 1, 7},       {5, 11, 7, -9},
    {3, 5, 6, -8},       {-13, -4, -8, 9},    {-5, 9, -3, -3},     {-4, -7, -3, -12},
    {6, 5, 8, 0},        {-7, 6, -6, 12},     {-13, 6, -5, -2},    {1, -10, 3, 10},
    {4, 1, 8, -4},       {-2, -2, 2, -13},    {2, -12, 12, 12},    {-2, -13, 0, -6},
    {4, 1, 9, 3},        {-6, -10, -3, -5},   {-3, -13, -1, 1},    {7, 5, 12, -11},
    {4, -2, 5, -7},      {-13, 9, -9, -5},    {7, 1, 8, 6},        {7, -8, 7, 6},
    {-7, -4, -7, 1},     {-8, 11, -7, -8},    {-13, 6, -12, -8},   {2, 4, 3, 9},
    {10, -5, 12, 3},     {-6, -5, -6, 7},     {8, -3, 9, -8},      {2, -12, 2, 8},
    {-11, -2, -10, 3},   {-12, -13, -7, -9},  {-11, 0, -10, -5},   {5, -3, 11, 8},
    {-2, -13, -1, 12},   {-1, -8, 0, 9},      {-13, -11, -12, -5}, {-10, -2, -10, 11},
    {-3, 9, -2, -13},    {2, -3, 3, 2},       {-9, -13, -4, 0},    {-4, 6, -3, -10},
    {-4, 12, -2, -7},    {-6, -11, -4, 9},    {6, -3, 6, 11},      {-13, 11, -5, 5},
    {11, 11, 12, 6},     {7, -5, 12, -2},     {-1, 12, 0, 7},      {-4, -8, -3, -2},
    {-7, 1, -6, 7},      {-13, -12, -8, -13}, {-7, -2, -6, -8},    {-8, 5, -6, -9},
    {-5, -1, -4, 5},     {-13, 7, -8, 10},    {1, 5, 5, -13},      {1, 0, 10, -13},
    {9, 12, 10, -1},     {5, -8, 10, -9},     {-1, 11, 1, -13},    {-9, -3, -6, 2},
    {-1, -10, 1, 12},    {-13, 1, -8, -10},   {8, -11, 10, -6},    {2, -13, 3, -6},
    {7, -13, 12, -9},    {-10, -10, -5, -7},  {-10, -8, -8, -13},  {4, -6, 8, 5},
    {3, 12, 8, -13},     {-4, 2, -3, -3},     {5, -13, 10, -12},   {4, -13, 5, -1},
    {-9, 9, -4, 3},      {0, 3, 3, -9},       {-12, 1, -6, 1},     {3, 2, 4, -8},
    {-10, -10, -10, 9},  {8, -13, 12, 12},    {-8, -12, -6, -5},   {2, 2, 3, 7},
    {10, 6, 11, -8},     {6, 8, 8, -12},      {-7, 10, -6, 5},     {-3, -9, -3, 9},
    {-1, -13, -1, 5},    {-3, -7, -3, 4},     {-8, -2, -8, 3},     {4, 2, 12, 12},
    {2, -5, 3, 11},      {6, -9, 11, -13},    {3, -1, 7, 12},      {11, -1, 12, 4},
    {-3, 0, -3, 6},      {4, -11, 4, 12},     {2, -4, 2, 1},       {-10, -6, -8, 1},
    {-13, 7, -11, 1},    {-13, 12, -11, -13}, {6, 0, 11, -13},     {0, -1, 1, 4},
    {-13, 3, -9, -2},    {-9, 8, -6, -3},     {-13, -6, -8, -2},   {5, -9, 8, 10},
    {2, 7, 3, -9},       {-1, -6, -1, -1},    {9, 5, 11, -2},      {11, -3, 12, -8},
    {3, 0, 3, 5},        {-1, 4, 0, 10},      {3, -6, 4, 5},       {-13, 0, -10, 5},
    {5, 8, 12, 11},      {8, 9, 9, -6},       {7, -4, 8, -12},     {-10, 4, -10, 9},
    {7, 3, 12, 4},       {9, -7, 10, -2},     {7, 0, 12, -2},      {-1, -6, 0, -11},
}};

constexpr int kDiscRadius = 15;
constexpr int kDiscRows = 2 * kDiscRadius + 1;
constexpr int kDiscColumns = 32;  // one more than needed, to fill whole SIMD vectors

// Half width of the disc in each row from its centre, rounded as in the ORB of OpenCV: symmetric
// under swapping x and y.
constexpr std::array<int, kDiscRadius + 1> kDiscHalfWidth = {15, 15, 15, 15, 14, 14, 14, 13,
                                                             13, 12, 11, 10, 9,  8,  6,  3};

// For each pixel of the square around the disc its x from the centre, and 1; outside the disc 0, 0.
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

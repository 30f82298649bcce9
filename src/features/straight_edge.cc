// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/straight_edge.h"

#include <cstdint>

#include "util/function_clones.h"

namespace hullslam {
namespace {

constexpr int kReach = 3;           // px; the circle of FAST
constexpr int64_t kMostRatio = 16;  // of the eigenvalues of the structure tensor

}  // namespace

// The sums are whole numbers, so they are exact. With the eigenvalues a > b, a > r b is the same as
// (a + b)^2 r > (r + 1)^2 a b, which needs only trace and determinant.
HULLSLAM_FUNCTION_CLONES
bool IsStraightEdge(const cv::Mat& image, cv::Point center) {
  int32_t xx = 0;
  int32_t xy = 0;
  int32_t yy = 0;
  for (int y = center.y - kReach; y <= center.y + kReach; ++y) {
    const auto* const above = image.ptr<uint8_t>(y - 1);
    const auto* const row = image.ptr<uint8_t>(y);
    const auto* const below = image.ptr<uint8_t>(y + 1);
    for (int x = center.x - kReach; x <= center.x + kReach; ++x) {
      const int32_t by_x = row[x + 1] - row[x - 1];
      const int32_t by_y = below[x] - above[x];
      xx += by_x * by_x;
      xy += by_x * by_y;
      yy += by_y * by_y;
    }
  }
  const int64_t trace = int64_t{xx} + yy;
  const int64_t determinant = int64_t{xx} * yy - int64_t{xy} * xy;
  return trace * trace * kMostRatio > (kMostRatio + 1) * (kMostRatio + 1) * determinant;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/corners.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "hullslam/util/check.h"
#include "util/function_clones.h"

namespace hullslam {
namespace {

constexpr int kCircle = 16;

// Bresenham's circle of radius 3, clockwise.
constexpr std::array<int, kCircle> kCircleX = {0, 1,  2,  3,  3,  3,  2,  1,
                                               0, -1, -2, -3, -3, -3, -2, -1};
constexpr std::array<int, kCircle> kCircleY = {-3, -3, -2, -1, 0, 1,  2,  3,
                                               3,  3,  2,  1,  0, -1, -2, -3};

struct Darkest {
  static uint8_t Inner(uint8_t a, uint8_t b) { return std::min(a, b); }
  static uint8_t Outer(uint8_t a, uint8_t b) { return std::max(a, b); }
};
struct Brightest {
  static uint8_t Inner(uint8_t a, uint8_t b) { return std::max(a, b); }
  static uint8_t Outer(uint8_t a, uint8_t b) { return std::min(a, b); }
};

// NOLINTBEGIN(cppcoreguidelines-pro-type-member-init): arrays of the hottest loop, filled at once.

// Applies Inner to each arc of 9 neighbours, and Outer to the results of all arcs. The arcs from i
// and from i + 1 share eight pixels, so it suffices to look at eight pairs of arcs.
template <typename Order>
inline uint8_t OverArcs(const std::array<uint8_t, kCircle>& p) {
  std::array<uint8_t, 8> pairs;
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) {
    pairs[i] = Order::Inner(p[2 * i + 1], p[(2 * i + 2) % kCircle]);
  }
  std::array<uint8_t, 8> fours;
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) {
    fours[i] = Order::Inner(pairs[i], pairs[(i + 1) % 8]);
  }
  std::array<uint8_t, 8> arcs;
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) {
    const uint8_t eight = Order::Inner(fours[i], fours[(i + 2) % 8]);
    arcs[i] = Order::Inner(eight, Order::Outer(p[2 * i], p[(2 * i + 9) % kCircle]));
  }
  uint8_t result = arcs[0];
#pragma GCC unroll 8
  for (int i = 1; i < 8; ++i) {
    result = Order::Outer(result, arcs[i]);
  }
  return result;
}

// Rows are processed in whole blocks, without a slow remainder. Therefore up to kBlock - 1 results
// after the last wanted pixel are computed from pixels of the following rows and ignored. With the
// smallest border there are always enough rows below, so nothing outside the image is read.
constexpr int kBlock = 32;
constexpr int kSmallestBorder = 8;

int BlockCount(int pixels) { return (pixels + kBlock - 1) / kBlock; }

// Computes the score of each pixel in `blocks` blocks from `row` on. An arc is brighter than the
// centre by more than t if its darkest pixel is. The code has no branches, so that the compiler can
// process many pixels at once.
HULLSLAM_FUNCTION_CLONES
void ScoreRow(const uint8_t* row, ptrdiff_t step, int blocks, uint8_t* __restrict scores) {
  std::array<const uint8_t*, kCircle> circle;
  for (int i = 0; i < kCircle; ++i) {
    circle[i] = row + kCircleY[i] * step + kCircleX[i];
  }
  for (int x = 0; x < blocks * kBlock; ++x) {
    std::array<uint8_t, kCircle> p;
#pragma GCC unroll 16
    for (int i = 0; i < kCircle; ++i) {
      p[i] = circle[i][x];
    }
    const uint8_t center = row[x];
    const uint8_t bright = std::max(OverArcs<Darkest>(p), center);
    const uint8_t dark = std::min(OverArcs<Brightest>(p), center);
    const uint8_t contrast = std::max<uint8_t>(bright - center, center - dark);
    scores[x] = std::max<uint8_t>(contrast, 1) - 1;
  }
}

// NOLINTEND(cppcoreguidelines-pro-type-member-init)

// Keeps a score if it is at least `threshold`, larger than the scores of the neighbours before it
// in raster order, and not smaller than the scores of those after it. All other scores become 0.
HULLSLAM_FUNCTION_CLONES
void MaximaOfRow(const uint8_t* above, const uint8_t* row, const uint8_t* below, int blocks,
                 uint8_t threshold, uint8_t* __restrict maxima) {
  for (int x = 0; x < blocks * kBlock; ++x) {
    const uint8_t before =
        std::max(std::max(above[x - 1], above[x]), std::max(above[x + 1], row[x - 1]));
    const uint8_t after =
        std::max(std::max(below[x - 1], below[x]), std::max(below[x + 1], row[x + 1]));
    const uint8_t lowest = std::max(after, threshold);
    const uint8_t score = row[x];
    maxima[x] = ((score > before) & (score >= lowest)) ? score : 0;
  }
}

// The scores of three rows, indexed by the x coordinate in the image.
struct ScoreRows {
  const uint8_t* above;
  const uint8_t* row;
  const uint8_t* below;

  Corner CornerAt(int x, int y) const {
    return {static_cast<int16_t>(x),
            static_cast<int16_t>(y),
            row[x],
            row[x - 1],
            row[x + 1],
            above[x],
            below[x]};
  }
};

// Most pixels are no maxima, so whole words of zeros are skipped.
void CollectRow(const uint8_t* maxima, const ScoreRows& scores, int begin, int end, int y,
                std::vector<Corner>& corners) {
  for (int x = begin; x < end; x += 8) {
    uint64_t word = 0;
    std::memcpy(&word, maxima + x, sizeof(word));
    if constexpr (std::endian::native == std::endian::big) {
      word = __builtin_bswap64(word);
    }
    while (word != 0) {
      const int byte = std::countr_zero(word) / 8;
      if (x + byte < end) {
        corners.push_back(scores.CornerAt(x + byte, y));
      }
      word &= ~(uint64_t{0xff} << (8 * byte));
    }
  }
}

// Position of the maximum of the parabola through (-1, before), (0, top) and (1, after), where top
// is the largest value.
float ParabolaTop(int before, int top, int after) {
  const int curvature = 2 * top - before - after;
  return curvature > 0 ? 0.5f * static_cast<float>(after - before) / static_cast<float>(curvature)
                       : 0.0f;
}

// Cells of equal size, about 30 px wide.
struct Cells {
  static constexpr int kSize = 30;
  int columns;
  int rows;
  int width;
  int height;

  explicit Cells(const cv::Mat& image)
      : columns(std::max(1, image.cols / kSize)),
        rows(std::max(1, image.rows / kSize)),
        width((image.cols + columns - 1) / columns),
        height((image.rows + rows - 1) / rows) {}
  int count() const { return columns * rows; }
  int IndexOf(const Corner& corner) const { return corner.y / height * columns + corner.x / width; }
};

}  // namespace

Eigen::Vector2f SubpixelOffset(const Corner& corner) {
  return {ParabolaTop(corner.left, corner.score, corner.right),
          ParabolaTop(corner.above, corner.score, corner.below)};
}

CornerDetector::CornerDetector(int initial_threshold, int minimum_threshold)
    : initial_threshold_(initial_threshold), minimum_threshold_(minimum_threshold) {
  Check(minimum_threshold >= 1 && minimum_threshold <= 255, "the FAST threshold is not 1 to 255");
}

void CornerDetector::Detect(const cv::Mat& image, int border, std::vector<Corner>& corners,
                            const std::function<bool(const Corner&)>& is_ignored) {
  Check(image.type() == CV_8UC1, "the image is not CV_8UC1");
  Check(border >= kSmallestBorder, "the border is narrower than 8 px");
  corners.clear();
  if (image.cols <= 2 * border || image.rows <= 2 * border) {
    return;
  }
  FindMaxima(image, border, corners);
  if (is_ignored) {
    std::erase_if(corners, is_ignored);
  }
  DropWeakInStrongCells(image, corners);
}

void CornerDetector::FindMaxima(const cv::Mat& image, int border, std::vector<Corner>& corners) {
  const auto width = static_cast<size_t>(image.cols + 2 * kBlock);
  score_rows_.assign(3 * width, 0);
  maxima_.assign(width, 0);
  const auto ring_row = [&](int y) {
    return score_rows_.data() + width * static_cast<size_t>(y % 3);
  };
  const auto step = static_cast<ptrdiff_t>(image.step);
  const int blocks = BlockCount(image.cols - 2 * border);
  // Scores are computed for one more pixel on each side, to compare the outermost corners with.
  const int score_blocks = BlockCount(image.cols - 2 * border + 2);
  for (int y = border - 1; y <= image.rows - border; ++y) {
    ScoreRow(image.ptr(y) + border - 1, step, score_blocks, ring_row(y) + border - 1);
    if (y > border) {
      const ScoreRows scores{ring_row(y - 2), ring_row(y - 1), ring_row(y)};
      MaximaOfRow(scores.above + border, scores.row + border, scores.below + border, blocks,
                  static_cast<uint8_t>(minimum_threshold_), maxima_.data() + border);
      CollectRow(maxima_.data(), scores, border, image.cols - border, y - 1, corners);
    }
  }
}

void CornerDetector::DropWeakInStrongCells(const cv::Mat& image, std::vector<Corner>& corners) {
  const Cells cells(image);
  strong_.assign(static_cast<size_t>(cells.count()), 0);
  cell_of_corner_.resize(corners.size());
  for (size_t i = 0; i < corners.size(); ++i) {
    const auto cell = static_cast<uint32_t>(cells.IndexOf(corners[i]));
    cell_of_corner_[i] = cell;
    strong_[cell] |= static_cast<uint8_t>(corners[i].score >= initial_threshold_);
  }
  size_t kept = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    // The corner is always written, and the count only grows if it is kept. This avoids a branch
    // that the CPU cannot predict.
    const bool keep = corners[i].score >= initial_threshold_ || strong_[cell_of_corner_[i]] == 0;
    corners[kept] = corners[i];
    kept += keep ? 1 : 0;
  }
  corners.resize(kept);
}

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

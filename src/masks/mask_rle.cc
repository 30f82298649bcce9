// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_rle.h"

#include <limits>
#include <numeric>
#include <opencv2/core.hpp>

#include "frame/detection/mask_outline.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

constexpr int kMostBits = 40;  // 32 bits of a run and the sign, rounded up to whole characters

// Reads one number: five bits per character, the lowest bits first. In a character, the bit with
// value 32 means that more characters follow. In the last one, the bit with value 16 is the sign.
// Returns nothing if the text does not start with such a number.
std::optional<int64_t> TakeNumber(std::string_view& text) {
  int64_t value = 0;
  for (int shift = 0; !text.empty() && shift < kMostBits; shift += 5) {
    const int bits = text.front() - '0';
    text.remove_prefix(1);
    if (bits < 0 || bits > 63) {
      return std::nullopt;
    }
    value |= static_cast<int64_t>(bits & 31) << shift;
    if ((bits & 32) == 0) {
      return (bits & 16) != 0 ? value - (int64_t{1} << (shift + 5)) : value;
    }
  }
  return std::nullopt;
}

cv::Rect Bounds(const MaskRuns& runs, int height) {
  cv::Rect bounds;
  uint64_t begin = 0;
  const auto rows = static_cast<uint64_t>(height);
  for (size_t i = 0; i < runs.size(); ++i) {
    const uint64_t end = begin + runs[i];
    if (i % 2 == 1 && end > begin) {
      const int first = static_cast<int>(begin / rows);
      const int last = static_cast<int>((end - 1) / rows);
      const bool is_one_column = first == last;
      const int top = is_one_column ? static_cast<int>(begin % rows) : 0;
      const int bottom = is_one_column ? static_cast<int>((end - 1) % rows) : height - 1;
      bounds |= cv::Rect(first, top, last - first + 1, bottom - top + 1);
    }
    begin = end;
  }
  return bounds;
}

}  // namespace

std::optional<MaskRuns> DecodeRuns(std::string_view text) {
  MaskRuns runs;
  while (!text.empty()) {
    const std::optional<int64_t> number = TakeNumber(text);
    if (!number) {
      return std::nullopt;
    }
    const int64_t run = *number + (runs.size() > 2 ? int64_t{runs[runs.size() - 2]} : 0);
    if (run < 0 || run > std::numeric_limits<uint32_t>::max()) {
      return std::nullopt;
    }
    runs.push_back(static_cast<uint32_t>(run));
  }
  return runs;
}

uint64_t CountPixels(const MaskRuns& runs) {
  return std::accumulate(runs.begin(), runs.end(), uint64_t{0});
}

std::vector<std::vector<Eigen::Vector2d>> OutlineRuns(const MaskRuns& runs, int width, int height) {
  Check(CountPixels(runs) == static_cast<uint64_t>(width) * static_cast<uint64_t>(height),
        "the runs of the mask do not add up to the size of the image");
  const cv::Rect bounds = Bounds(runs, height);
  if (bounds.empty()) {
    return {};
  }
  cv::Mat columns =
      cv::Mat::zeros(width, height, CV_8UC1);  // transposed, so that runs are contiguous
  size_t begin = 0;
  for (size_t i = 0; i < runs.size(); ++i) {
    if (i % 2 == 1) {
      std::fill_n(columns.data + begin, runs[i], uint8_t{1});
    }
    begin += runs[i];
  }
  const cv::Rect transposed(bounds.y, bounds.x, bounds.height, bounds.width);
  auto outlines = FindMaskOutlines(columns(transposed).t());
  for (auto& outline : outlines) {
    for (Eigen::Vector2d& point : outline) {
      point += Eigen::Vector2d(bounds.x, bounds.y);
    }
  }
  return outlines;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/mask_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <unordered_map>
#include <utility>

#include "geometry/polygon.h"
#include "hullslam/util/check.h"

namespace hullslam {

void SortByArea(std::vector<std::vector<Eigen::Vector2d>>& outlines) {
  std::vector<std::pair<double, size_t>> areas;
  for (size_t i = 0; i < outlines.size(); ++i) {
    areas.emplace_back(-std::abs(SignedArea(outlines[i])),
                       i);  // the largest first; ties in the original order
  }
  std::sort(areas.begin(), areas.end());
  std::vector<std::vector<Eigen::Vector2d>> sorted;
  for (const auto& [negative_area, i] : areas) {
    if (-negative_area >= kSmallestOutlineArea) {
      sorted.push_back(std::move(outlines[i]));
    }
  }
  outlines = std::move(sorted);
}

namespace {

using Outline = std::vector<Eigen::Vector2d>;

// Follows the borders of the parts of all numbers in one pass from above, after Suzuki and Abe,
// Topological structural analysis of digitized binary images by border following, 1985. A part has
// one border around it and one around each of its holes.
//
// Borders run on a lattice with twice the resolution of the image, which has an empty line around
// it. Each point of the lattice is the centre of a pixel, at (2x, 2y), the middle of an edge
// between two pixels, or a corner of four pixels. A middle is inside if at least one of its two
// pixels is inside; a corner is inside if at least two of its four pixels are. So the outermost
// inside points are the middles of the edges of a part and, along straight edges, also the corners.
class BorderTracer {
 public:
  explicit BorderTracer(const cv::Mat& labels) {
    cv::copyMakeBorder(labels, labels_, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
    marks_ = cv::Mat::zeros(labels_.size(), CV_8UC1);
  }

  std::map<int, std::vector<Outline>> Run() {
    for (int y = 1; y + 1 < labels_.rows; ++y) {
      const auto* const row = labels_.ptr<int32_t>(y);
      for (int x = 1; x + 1 < labels_.cols; ++x) {
        if (row[x] != 0 && row[x] != row[x - 1]) {
          BeginRun({x, y}, row[x]);
        }
        if (row[x] != 0 && row[x] != row[x + 1]) {
          EndRun({x, y}, row[x]);
        }
      }
    }
    for (auto& [number, outlines] : outlines_) {
      std::reverse(outlines.begin(), outlines.end());
    }
    return std::move(outlines_);
  }

 private:
  // What is known of a side of a pixel beyond which its part ends.
  static constexpr uint8_t kLeft = 1;
  static constexpr uint8_t kRight = 2;
  static constexpr uint8_t kRightIsOutside = 4;

  // The eight directions, counter-clockwise from the right.
  static constexpr std::array<std::array<int, 2>, 8> kSteps = {
      {{1, 0}, {1, -1}, {0, -1}, {-1, -1}, {-1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
  static constexpr int kToTheRight = 0;
  static constexpr int kToTheLeft = 4;

  static cv::Point Step(const cv::Point& point, int direction) {
    return {point.x + kSteps[direction][0], point.y + kSteps[direction][1]};
  }

  // The left side of a run of equal pixels that no border has passed yet: a part begins. It is in a
  // hole of another part of its number if the side of the last one in this row is not outside.
  void BeginRun(const cv::Point& pixel, int number) {
    if ((marks_.at<uint8_t>(pixel) & kLeft) != 0) {
      return;
    }
    const auto last = last_.find(number);
    const bool is_outside = last == last_.end() || last->second.y != pixel.y ||
                            (marks_.at<uint8_t>(last->second) & kRightIsOutside) != 0;
    Outline outline = Trace({2 * pixel.x, 2 * pixel.y - 1}, kToTheLeft, number, is_outside);
    if (is_outside) {
      outlines_[number].push_back(std::move(outline));
    }
  }

  // The right side of a run that no border has passed yet: a hole begins.
  void EndRun(const cv::Point& pixel, int number) {
    if ((marks_.at<uint8_t>(pixel) & kRight) == 0) {
      Trace({2 * pixel.x + 1, 2 * pixel.y}, kToTheRight, number, /*is_outside=*/false);
    }
    last_[number] = pixel;
  }

  bool IsInside(const cv::Point& point, int number) const {
    const auto* const above = labels_.ptr<int32_t>(point.y / 2);
    const auto* const below = labels_.ptr<int32_t>((point.y + 1) / 2);
    const int left = point.x / 2;
    const int right = (point.x + 1) / 2;
    return (above[left] == number) + (above[right] == number) + (below[left] == number) +
               (below[right] == number) >=
           2;
  }

  // Marks the side of a pixel whose middle this point is.
  void MarkSide(const cv::Point& point, int number, bool is_outside) {
    if (point.x % 2 == 0 || point.y % 2 != 0) {
      return;
    }
    const cv::Point left(point.x / 2, point.y / 2);
    const cv::Point right(left.x + 1, left.y);
    if (labels_.at<int32_t>(left) != number) {
      marks_.at<uint8_t>(right) |= kLeft;
    } else if (labels_.at<int32_t>(right) != number) {
      marks_.at<uint8_t>(left) |= kRight;
      if (is_outside) {
        marks_.at<uint8_t>(left) |= kRightIsOutside;
      }
    }
  }

  // Follows the border that passes `start`, beyond which the part ends in the direction `outwards`.
  // Returns the points at which it turns.
  Outline Trace(const cv::Point& start, int outwards, int number, bool is_outside) {
    int direction = outwards;
    do {
      direction = (direction + 7) % 8;
    } while (!IsInside(Step(start, direction), number));
    const cv::Point last = Step(start, direction);
    int former = (direction + 4) % 8;  // the direction in which the border comes back to the start
    Outline outline;
    for (cv::Point point = start;;) {
      MarkSide(point, number, is_outside);
      do {
        direction = (direction + 1) % 8;
      } while (!IsInside(Step(point, direction), number));
      if (direction != former) {
        outline.emplace_back(0.5 * point.x - 1.0, 0.5 * point.y - 1.0);
      }
      former = direction;
      const cv::Point next = Step(point, direction);
      if (next == start && point == last) {
        return outline;
      }
      point = next;
      direction = (direction + 4) % 8;
    }
  }

  cv::Mat labels_;                                // CV_32SC1
  cv::Mat marks_;                                 // of each pixel of `labels_`
  std::unordered_map<int, cv::Point> last_ = {};  // of each number, the end of its last run
  std::map<int, std::vector<Outline>> outlines_ = {};
};

}  // namespace

std::vector<Outline> FindMaskOutlines(const cv::Mat& mask) {
  Check(mask.type() == CV_8UC1, "the mask is not CV_8UC1");
  constexpr int kInside = 255;
  return FindLabelOutlines(mask != 0)[kInside];
}

std::map<int, std::vector<Outline>> FindLabelOutlines(const cv::Mat& labels) {
  Check(labels.type() == CV_8UC1 || labels.type() == CV_16UC1 || labels.type() == CV_32SC1,
        "the labels are not CV_8UC1, CV_16UC1 or CV_32SC1");
  cv::Mat numbers;
  labels.convertTo(numbers, CV_32SC1);
  return BorderTracer(numbers).Run();
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/label_image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <utility>

#include "frame/mask_outline.h"
#include "geometry/polyline.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

template <typename Label>
std::map<int, cv::Rect> FindBoxes(const cv::Mat& labels) {
  std::map<int, cv::Rect> instances;
  for (int y = 0; y < labels.rows; ++y) {
    const auto* const row = labels.ptr<Label>(y);
    for (int x = 0; x < labels.cols;) {
      const int begin = x;
      const Label label = row[x];
      while (x < labels.cols && row[x] == label) {
        ++x;
      }
      if (label != 0) {
        instances[label] |= cv::Rect(begin, y, x - begin, 1);
      }
    }
  }
  return instances;
}

}  // namespace

std::map<int, cv::Rect> FindInstances(const cv::Mat& labels) {
  switch (labels.type()) {
    case CV_8UC1:
      return FindBoxes<uint8_t>(labels);
    case CV_16UC1:
      return FindBoxes<uint16_t>(labels);
    default:
      Check(labels.type() == CV_32SC1, "the labels are not CV_8UC1, CV_16UC1 or CV_32SC1");
      return FindBoxes<int32_t>(labels);
  }
}

std::vector<std::vector<Eigen::Vector2d>> OutlinesOf(const cv::Mat& labels, int number,
                                                     const cv::Rect& box) {
  auto outlines = FindMaskOutlines(labels(box) == number);
  for (auto& outline : outlines) {
    for (Eigen::Vector2d& point : outline) {
      point += Eigen::Vector2d(box.x, box.y);
    }
  }
  return outlines;
}

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

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/mask_outline.h"

#include <array>
#include <map>
#include <opencv2/imgproc.hpp>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;

// The steps to the right, down, left and up.
constexpr std::array<std::array<int, 2>, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

std::map<int, cv::Rect> BoundingBoxes(const cv::Mat& instance) {
  std::map<int, cv::Rect> boxes;
  for (int y = 0; y < instance.rows; ++y) {
    const auto* row = instance.ptr<int16_t>(y);
    for (int x = 0; x < instance.cols; ++x) {
      if (row[x] >= 0) {
        boxes[row[x]] |= cv::Rect(x, y, 1, 1);
      }
    }
  }
  return boxes;
}

// The largest 4-connected component of `mask` with a border of one empty pixel, and its area.
std::pair<cv::Mat, int> LargestComponent(const cv::Mat& mask) {
  cv::Mat padded;
  cv::copyMakeBorder(mask, padded, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centroids;
  const int count = cv::connectedComponentsWithStats(padded, labels, stats, centroids, 4);
  int best = 1;
  for (int label = 2; label < count; ++label) {
    if (stats.at<int>(label, cv::CC_STAT_AREA) > stats.at<int>(best, cv::CC_STAT_AREA)) {
      best = label;
    }
  }
  return {labels == best, stats.at<int>(best, cv::CC_STAT_AREA)};
}

// Walks along the edges between pixels around the component, with the inside to the right, and
// returns the middle of each edge. Here the corners of pixels have integer coordinates.
std::vector<Vector2d> TraceEdges(const cv::Mat& component) {
  const auto inside = [&](int x, int y) { return component.at<uint8_t>(y, x) != 0; };
  std::array<int, 2> start = {0, 0};
  for (int i = 0; i < static_cast<int>(component.total()); ++i) {
    if (inside(i % component.cols, i / component.cols)) {
      start = {i % component.cols, i / component.cols};  // upper left corner of the first pixel
      break;
    }
  }
  std::vector<Vector2d> middles;
  std::array<int, 2> at = start;
  size_t heading = 0;
  do {
    const std::array<int, 2> step = kSteps[heading];
    middles.emplace_back(at[0] + 0.5 * step[0], at[1] + 0.5 * step[1]);
    at = {at[0] + step[0], at[1] + step[1]};
    // The pixels ahead of the corner, to the left and to the right of the heading.
    const std::array<int, 2> right = kSteps[(heading + 1) % 4];
    const auto ahead = [&](int side) {
      return inside(at[0] + (step[0] + side * right[0] - 1) / 2,
                    at[1] + (step[1] + side * right[1] - 1) / 2);
    };
    if (!ahead(1)) {
      heading = (heading + 1) % 4;
    } else if (ahead(-1)) {
      heading = (heading + 3) % 4;
    }
  } while (at != start || heading != 0);
  return middles;
}

// Removes vertices that are on the straight line between their neighbours.
std::vector<Vector2d> DropCollinear(const std::vector<Vector2d>& points) {
  std::vector<Vector2d> kept;
  for (size_t i = 0; i < points.size(); ++i) {
    const Vector2d before = points[i] - points[(i + points.size() - 1) % points.size()];
    const Vector2d after = points[(i + 1) % points.size()] - points[i];
    if (before.x() * after.y() != before.y() * after.x()) {
      kept.push_back(points[i]);
    }
  }
  return kept;
}

}  // namespace

std::vector<InstanceOutline> FindOutlines(const cv::Mat& instance, int min_area) {
  Check(instance.type() == CV_16SC1, "the instance image is not CV_16SC1");
  std::vector<InstanceOutline> outlines;
  for (const auto& [object, box] : BoundingBoxes(instance)) {
    const auto [component, area] = LargestComponent(instance(box) == object);
    if (area < min_area) {
      continue;
    }
    InstanceOutline outline{.object = object, .area = area, .vertices = {}};
    outline.vertices = DropCollinear(TraceEdges(component));
    for (Vector2d& vertex : outline.vertices) {
      // Converts from corners in the bordered region to centres of pixels in the image.
      vertex += Vector2d(box.x - 1.5, box.y - 1.5);
    }
    outlines.push_back(std::move(outline));
  }
  return outlines;
}

}  // namespace hullslam::synthetic

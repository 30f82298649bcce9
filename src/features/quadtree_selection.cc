// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/quadtree_selection.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace hullslam {
namespace {

// The strongest corner; ties go to the first.
const Corner& Strongest(const std::vector<Corner>& corners, size_t begin, size_t end) {
  size_t best = begin;
  for (size_t i = begin + 1; i < end; ++i) {
    if (corners[i].score > corners[best].score) {
      best = i;
    }
  }
  return corners[best];
}

}  // namespace

// A total order, so that the result does not depend on the implementation of the heap.
bool QuadtreeSelection::IsCutLater(const Node& a, const Node& b) {
  return std::tuple(b.depth, a.count(), b.begin) < std::tuple(a.depth, b.count(), a.begin);
}

void QuadtreeSelection::Select(std::vector<Corner>& corners, cv::Size size, size_t count,
                               std::vector<Corner>& selected) {
  selected.clear();
  if (corners.size() <= count) {
    selected = corners;
    return;
  }
  heap_.clear();
  leaves_.clear();
  scratch_.resize(corners.size());
  Add({0, 0, size.width, size.height, 0, corners.size(), 0});
  while (!heap_.empty() && heap_.size() + leaves_.size() < count) {
    std::pop_heap(heap_.begin(), heap_.end(), IsCutLater);
    const Node node = heap_.back();
    heap_.pop_back();
    Cut(node, corners);
  }
  for (const auto* nodes : {&heap_, &leaves_}) {
    for (const Node& node : *nodes) {
      selected.push_back(Strongest(corners, node.begin, node.end));
    }
  }
  std::sort(selected.begin(), selected.end(), [](const Corner& a, const Corner& b) {
    return std::tuple(a.y, a.x) < std::tuple(b.y, b.x);
  });
}

void QuadtreeSelection::Add(const Node& node) {
  if (node.count() == 1) {
    leaves_.push_back(node);
  } else if (node.count() > 1) {
    heap_.push_back(node);
    std::push_heap(heap_.begin(), heap_.end(), IsCutLater);
  }
}

// Sorts the corners of the box by quarter and keeps their order within each quarter.
void QuadtreeSelection::Cut(const Node& node, std::vector<Corner>& corners) {
  const int x = (node.x0 + node.x1) / 2;
  const int y = (node.y0 + node.y1) / 2;
  const auto quarter = [&](const Corner& c) {
    return static_cast<size_t>(2 * (c.y >= y ? 1 : 0) + (c.x >= x ? 1 : 0));
  };
  std::array<size_t, 4> end{};
  for (size_t i = node.begin; i < node.end; ++i) {
    ++end[quarter(corners[i])];
  }
  std::array<size_t, 4> begin{node.begin};
  for (size_t q = 1; q < 4; ++q) {
    begin[q] = begin[q - 1] + end[q - 1];
  }
  end = begin;
  for (size_t i = node.begin; i < node.end; ++i) {
    scratch_[end[quarter(corners[i])]++] = corners[i];
  }
  std::copy(scratch_.begin() + static_cast<ptrdiff_t>(node.begin),
            scratch_.begin() + static_cast<ptrdiff_t>(node.end),
            corners.begin() + static_cast<ptrdiff_t>(node.begin));
  const int depth = node.depth + 1;
  Add({node.x0, node.y0, x, y, begin[0], end[0], depth});
  Add({x, node.y0, node.x1, y, begin[1], end[1], depth});
  Add({node.x0, y, x, node.y1, begin[2], end[2], depth});
  Add({x, y, node.x1, node.y1, begin[3], end[3], depth});
}

}  // namespace hullslam

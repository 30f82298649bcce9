// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <opencv2/core/types.hpp>
#include <vector>

#include "features/corners.h"

namespace hullslam {

// Selects corners that are evenly distributed. The image is split into quarters, and these again,
// until there are as many non-empty boxes as corners are wanted; the strongest corner of each box
// is selected (Mur-Artal and Tardos 2017). Large boxes are split first, among boxes of the same
// size those with the most corners. Keeps its buffers from call to call.
class QuadtreeSelection {
 public:
  // `selected` is overwritten with about `count` of the corners, in raster order. It may have up to
  // 2 more, because a box is split into up to four boxes. If there are at most `count` corners, all
  // are selected. `corners` is reordered. All of them must lie in the box from (0, 0) to `size`.
  void Select(std::vector<Corner>& corners, cv::Size size, size_t count,
              std::vector<Corner>& selected);

 private:
  struct Node {
    int x0, y0, x1, y1;  // px; x1 and y1 are exclusive
    size_t begin, end;   // range of the corners inside
    int depth;
    size_t count() const { return end - begin; }
  };
  static bool IsCutLater(const Node& a, const Node& b);
  void Add(const Node& node);
  void Cut(const Node& node, std::vector<Corner>& corners);

  std::vector<Node> heap_;    // boxes with more than one corner
  std::vector<Node> leaves_;  // boxes with one corner
  std::vector<Corner> scratch_;
};

}  // namespace hullslam

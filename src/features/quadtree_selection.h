// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <opencv2/core/types.hpp>
#include <vector>

#include "features/corners.h"

namespace hullslam {

// Chooses corners that are spread evenly: the image is cut into quarters, and these again, until
// there are as many non-empty boxes as corners wanted; of each box the strongest corner is taken
// (Mur-Artal and Tardos 2017). Large boxes are cut before small ones, of boxes of one size those
// with the most corners first. Keeps its buffers from call to call.
class QuadtreeSelection {
 public:
  // `selected` is overwritten with about `count` of the corners (at most 2 more, as a box is cut
  // into up to four), in raster order; with all of them if they are not more than `count`.
  // `corners` is sorted anew. All of them must lie in a box from (0, 0) to `size`.
  void Select(std::vector<Corner>& corners, cv::Size size, size_t count,
              std::vector<Corner>& selected);

 private:
  struct Node {
    int x0, y0, x1, y1;  // px, without x1 and y1
    size_t begin, end;   // of the corners inside
    int depth;
    size_t count() const { return end - begin; }
  };
  static bool IsCutLater(const Node& a, const Node& b);
  void Add(const Node& node);
  void Cut(const Node& node, std::vector<Corner>& corners);

  std::vector<Node> heap_;    // boxes of more than one corner
  std::vector<Node> leaves_;  // boxes of one corner
  std::vector<Corner> scratch_;
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

namespace hullslam {

// The indices of the ids that are valid, in increasing order.
template <typename IdType>
std::vector<uint32_t> IndicesOfValid(const std::vector<IdType>& ids) {
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < ids.size(); ++i) {
    if (ids[i].IsValid()) {
      indices.push_back(i);
    }
  }
  return indices;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/rejection.h"

#include <array>

namespace hullslam {

std::string ToString(ObjectRejection reason) {
  static constexpr std::array<const char*, kObjectRejectionCount> kNames = {
      "few_views",    "little_parallax",   "no_start",    "not_refined",
      "not_in_front", "axes_out_of_range", "low_overlap", "off_points",
      "stretched",    "large_misfit",      "elongated",   "part",
      "seldom_seen",  "contradicted",      "fused"};
  return kNames.at(static_cast<size_t>(reason));
}

}  // namespace hullslam

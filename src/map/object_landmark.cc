// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/object_landmark.h"

#include <algorithm>

#include "hullslam/util/check.h"
#include "util/text.h"

namespace hullslam {

const std::string& ObjectLandmark::Label() const {
  Check(!votes.empty(), "an object that nothing observes has no class");
  return std::max_element(votes.begin(), votes.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

bool ObjectLandmark::IsName(std::string_view text) {
  constexpr size_t kMostBytes = 100;
  return text.size() <= kMostBytes && text == Printable(text);
}

bool ObjectLandmark::IsSize(double longest_side) {
  return longest_side >= 1e-3 && longest_side <= 100.0;
}

}  // namespace hullslam

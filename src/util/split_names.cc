// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/split_names.h"

#include <algorithm>

#include "util/trim.h"

namespace hullslam {

std::set<std::string> SplitNames(std::string_view names) {
  std::set<std::string> split;
  while (!names.empty()) {
    const size_t comma = std::min(names.find(','), names.size());
    if (const std::string_view name = Trim(names.substr(0, comma)); !name.empty()) {
      split.emplace(name);
    }
    names.remove_prefix(std::min(comma + 1, names.size()));
  }
  return split;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/edit_distance.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace hullslam {

size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i + 1);
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

bool IsMisspelt(std::string_view written, std::string_view known) {
  const auto without_digits = [](std::string_view text) {
    std::string rest(text);
    std::erase_if(rest, [](char c) { return c >= '0' && c <= '9'; });
    return rest;
  };
  // The part behind the dot tells names such as Camera.k4 and Camera.bf apart.
  const size_t begin = written.rfind('.') + 1;  // 0 without a dot
  const size_t of_part = written.substr(0, begin) == known.substr(0, begin)
                             ? std::max(written.size(), known.size()) - begin
                             : std::max(written.size(), known.size());
  const size_t distance = EditDistance(written, known);
  return distance <= std::max<size_t>(2, written.size() / 4) && 2 * distance <= of_part &&
         without_digits(written) != without_digits(known);
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/natural_order.h"

#include <algorithm>
#include <compare>

namespace hullslam {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Removes the digits at the beginning of the text, of which there is at least one, and returns them
// without leading zeros.
std::string_view TakeNumber(std::string_view& text) {
  const auto count =
      static_cast<size_t>(std::find_if_not(text.begin(), text.end(), IsDigit) - text.begin());
  std::string_view number = text.substr(0, count);
  text.remove_prefix(count);
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return number;
}

// The order of the first number or character of both, which are removed.
std::strong_ordering CompareFirst(std::string_view& a, std::string_view& b) {
  if (IsDigit(a[0]) && IsDigit(b[0])) {
    const std::string_view x = TakeNumber(a);
    const std::string_view y = TakeNumber(b);
    return x.size() != y.size() ? x.size() <=> y.size() : x <=> y;
  }
  const auto order = static_cast<unsigned char>(a[0]) <=> static_cast<unsigned char>(b[0]);
  a.remove_prefix(1);
  b.remove_prefix(1);
  return order;
}

}  // namespace

bool IsNaturallyBefore(std::string_view a, std::string_view b) {
  std::string_view rest_of_a = a;
  std::string_view rest_of_b = b;
  while (!rest_of_a.empty() && !rest_of_b.empty()) {
    const std::strong_ordering order = CompareFirst(rest_of_a, rest_of_b);
    if (order != 0) {
      return order < 0;
    }
  }
  if (rest_of_a.empty() != rest_of_b.empty()) {
    return rest_of_a.empty();
  }
  return a < b;
}

}  // namespace hullslam

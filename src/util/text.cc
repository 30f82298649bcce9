// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

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

namespace {

// The first character of a text.
struct Character {
  uint32_t code = 0;
  size_t bytes = 0;  // 0 if the text does not begin with valid UTF-8
};

Character FirstOf(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<uint8_t>(text[i]); };
  const uint8_t lead = byte(0);
  if (lead < 0x80) {
    return {lead, 1};
  }
  const size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc0 || lead > 0xf7 || text.size() < bytes) {
    return {};
  }
  uint32_t code = lead & (0x7fU >> bytes);
  for (size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) {
      return {};
    }
    code = code << 6 | (byte(i) & 0x3fU);
  }
  constexpr uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // by the number of bytes
  const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
  return code < kLeast[bytes] || code > 0x10ffff || is_surrogate ? Character()
                                                                 : Character{code, bytes};
}

bool IsControl(uint32_t code) {
  const auto is_from = [code](uint32_t first, uint32_t last) {
    return code >= first && code <= last;
  };
  return code < 0x20 || is_from(0x7f, 0x9f) ||                // C0, DEL and C1
         is_from(0x2028, 0x202e) || is_from(0x2066, 0x2069);  // ends of lines, directions
}

}  // namespace

std::string Printable(std::string_view text, std::string_view kept) {
  std::string printable;
  printable.reserve(text.size());
  while (!text.empty()) {
    const Character character = FirstOf(text);
    const size_t bytes = character.bytes > 0 ? character.bytes : 1;
    const bool is_kept = bytes == 1 && kept.find(text.front()) != std::string_view::npos;
    if (is_kept || (character.bytes > 0 && !IsControl(character.code))) {
      printable += text.substr(0, bytes);
    } else {
      printable += '?';
    }
    text.remove_prefix(bytes);
  }
  return printable;
}

bool IsUtf8(std::string_view text) {
  while (!text.empty()) {
    const size_t bytes = FirstOf(text).bytes;
    if (bytes == 0) {
      return false;
    }
    text.remove_prefix(bytes);
  }
  return true;
}

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

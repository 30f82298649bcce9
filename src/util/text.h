// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>

namespace hullslam {

// The functions of <cctype> ask the locale, which a program of a user may set: in a locale of
// Latin-1 they take bytes of UTF-8 for letters and blanks. These know ASCII only.

constexpr bool IsDigit(char c) { return c >= '0' && c <= '9'; }

constexpr bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

constexpr bool IsBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

constexpr bool IsControl(char c) { return (c >= '\0' && c < ' ') || c == '\x7f'; }

// The text with small letters instead of A to Z. The locale does not matter, and the bytes of
// other letters stay.
inline std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  }
  return lower;
}

// The text without the blanks, tabs and carriage returns at both of its ends.
inline std::string_view Trim(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

// Splits a list of names at its commas and removes the blanks around each name: "person, cat" gives
// two names.
std::set<std::string> SplitNames(std::string_view names);

// A user's text for messages: in printable ASCII, and shortened if it is long.
inline std::string ShowText(std::string_view text, size_t longest = 120) {
  std::string shown(text.substr(0, longest));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.size() > longest ? shown + "..." : shown;
}

// The text in valid UTF-8 and without characters that control a terminal or a text file: '?' stands
// for control characters, of characters that change the direction of writing or end a
// line, and of bytes that are not UTF-8. The characters in `kept`, such as "\n", stay as they are.
std::string Printable(std::string_view text, std::string_view kept = {});

// Whether all bytes of the text are valid UTF-8.
bool IsUtf8(std::string_view text);

// A number and what it counts, for messages: "1 keyframe", "0 keyframes". `noun` is in the
// singular and has a plural in -s.
inline std::string Counted(size_t number, std::string_view noun) {
  return std::to_string(number).append(" ").append(noun).append(number == 1 ? "" : "s");
}

// The number of characters to insert, remove or replace to make `a` from `b` (Levenshtein 1966).
// Messages use it to suggest the right name for a misspelt one.
size_t EditDistance(std::string_view a, std::string_view b);

// Whether `written` may be a misspelt `known`: one character in four is wrong at most, or two in
// short names, but never more than half of the part behind the last dot. Names that differ in
// numbers only, as Camera.k4 and Camera.k1, are different things.
bool IsMisspelt(std::string_view written, std::string_view known);

}  // namespace hullslam

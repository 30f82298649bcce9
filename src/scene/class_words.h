// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// The words of a text in small letters. Letters, digits and all bytes beyond ASCII belong to words;
// everything else, such as a comma or a hyphen, is between words.
std::vector<std::string> SplitWords(std::string_view text);

// The classes that the words at the beginning of a text can mean.
struct ClassMatch {
  std::set<std::string> labels;
  size_t words = 0;  // number of words that were matched; 0 if there is no match
};

// A label is matched by all of its words ("potted plant"), or by its last one alone ("plant"). The
// last word may be in the plural. The longest match counts, and full labels count before parts.
ClassMatch MatchClass(std::span<const std::string> words, const std::set<std::string>& labels);

}  // namespace hullslam

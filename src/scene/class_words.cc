// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/class_words.h"

#include <algorithm>

#include "util/text.h"

namespace hullslam {
namespace {

bool IsInWord(char c) { return static_cast<unsigned char>(c) >= 0x80 || IsDigit(c) || IsLetter(c); }

// Whether `word` is `singular` or a plural of it.
bool IsFormOf(const std::string& word, const std::string& singular) {
  if (word == singular || word == singular + "s" || word == singular + "es") {
    return true;
  }
  const auto with_ending = [&](std::string_view ending, std::string_view plural) {
    return singular.ends_with(ending) &&
           word == singular.substr(0, singular.size() - ending.size()) + std::string(plural);
  };
  return with_ending("y", "ies") || with_ending("fe", "ves") || with_ending("f", "ves") ||
         with_ending("person", "people") || with_ending("mouse", "mice");
}

// Whether the words begin with the words of the label.
bool BeginsWith(std::span<const std::string> words, const std::vector<std::string>& label) {
  return !label.empty() && words.size() >= label.size() &&
         std::equal(label.begin(), label.end() - 1, words.begin()) &&
         IsFormOf(words[label.size() - 1], label.back());
}

}  // namespace

std::vector<std::string> SplitWords(std::string_view text) {
  std::vector<std::string> words;
  bool is_open = false;
  for (const char c : LowerCase(text)) {
    if (!IsInWord(c)) {
      is_open = false;
      continue;
    }
    if (!is_open) {
      words.emplace_back();
      is_open = true;
    }
    words.back() += c;
  }
  return words;
}

ClassMatch MatchClass(std::span<const std::string> words, const std::set<std::string>& labels) {
  ClassMatch best;
  for (const std::string& label : labels) {
    const std::vector<std::string> parts = SplitWords(label);
    if (BeginsWith(words, parts) && parts.size() >= best.words) {
      best.labels = parts.size() > best.words ? std::set<std::string>() : best.labels;
      best.labels.insert(label);
      best.words = parts.size();
    }
  }
  if (best.words > 0 || words.empty()) {
    return best;
  }
  for (const std::string& label : labels) {
    const std::vector<std::string> parts = SplitWords(label);
    if (!parts.empty() && IsFormOf(words.front(), parts.back())) {
      best.labels.insert(label);
      best.words = 1;
    }
  }
  return best;
}

}  // namespace hullslam

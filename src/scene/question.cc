// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/question.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <span>

#include "hullslam/util/error.h"
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

namespace {

using Words = std::vector<std::string>;

struct RelationWords {
  const char* words;
  AskedRelation relation;
};

// Longer phrases come before the shorter ones that they begin with.
constexpr std::array<RelationWords, 22> kRelationWords = {{
    {"in front of", AskedRelation::kInFrontOf},
    {"on top of", AskedRelation::kOn},
    {"next to", AskedRelation::kBeside},
    {"close to", AskedRelation::kNear},
    {"part of", AskedRelation::kPartOf},
    {"hidden by", AskedRelation::kHiddenBy},
    {"standing on", AskedRelation::kOn},
    {"lying on", AskedRelation::kOn},
    {"inside of", AskedRelation::kIn},
    {"inside", AskedRelation::kIn},
    {"in", AskedRelation::kIn},
    {"on", AskedRelation::kOn},
    {"upon", AskedRelation::kOn},
    {"under", AskedRelation::kUnder},
    {"below", AskedRelation::kUnder},
    {"beneath", AskedRelation::kUnder},
    {"supporting", AskedRelation::kUnder},
    {"supports", AskedRelation::kUnder},
    {"beside", AskedRelation::kBeside},
    {"behind", AskedRelation::kBehind},
    {"near", AskedRelation::kNear},
    {"by", AskedRelation::kNear},
}};
constexpr std::array<const char*, 7> kArticles = {"the", "a", "an", "any", "some", "my", "all"};
constexpr std::array<const char*, 5> kAnyThing = {"thing", "things", "something", "anything",
                                                  "everything"};

// How questions and requests begin. Longer ones come before those that they begin with.
constexpr std::array<const char*, 13> kOpenings = {
    "is there", "are there", "where is", "where are", "what is", "what are", "show me",
    "show",     "find",      "which",    "what",      "is",      "are"};

template <typename List>
bool IsOneOf(const List& list, const std::string& word) {
  return std::any_of(list.begin(), list.end(), [&](const char* known) { return word == known; });
}

class QuestionParser {
 public:
  QuestionParser(Words words, const std::set<std::string>& labels)
      : words_(std::move(words)), labels_(labels) {}

  AskedThing Parse() {
    if (words_.empty()) {
      throw InputError("the question has no word, expected such as \"cup on the book\"");
    }
    SkipOpening();
    AskedThing thing;
    if (IsAtRelation()) {
      thing.text = "thing";
    } else {
      thing = ParseThing();
    }
    AskedThing* described = &thing;  // what the next relation is about
    while (place_ < words_.size()) {
      if (TakeOne("and") || TakeOne("is") || TakeOne("are")) {
        continue;
      }
      if (TakeOne("that") || TakeOne("which")) {
        if (!TakeOne("is") && !TakeOne("are")) {
          Fail("'is'");
        }
        described = last_;
      }
      described = AddCondition(thing, *described);
    }
    return thing;
  }

 private:
  std::span<const std::string> Rest() const { return std::span(words_).subspan(place_); }

  bool TakeOne(const char* word) {
    const bool is_next = place_ < words_.size() && words_[place_] == word;
    place_ += is_next ? 1 : 0;
    return is_next;
  }

  bool TakePhrase(const Words& phrase) {
    const auto rest = Rest();
    const bool is_next =
        rest.size() >= phrase.size() && std::equal(phrase.begin(), phrase.end(), rest.begin());
    place_ += is_next ? phrase.size() : 0;
    return is_next;
  }

  // Skips "is there" and the like, which say nothing of the thing, unless a class is named so.
  void SkipOpening() {
    if (MatchClass(Rest(), labels_).words > 0) {
      return;
    }
    for (const char* const opening : kOpenings) {
      if (TakePhrase(SplitWords(opening))) {
        return;
      }
    }
  }

  // Whether the next words are a relation, as in "what is on the table".
  bool IsAtRelation() {
    const size_t begin = place_;
    const bool is_next = std::any_of(
        kRelationWords.begin(), kRelationWords.end(),
        [&](const RelationWords& known) { return TakePhrase(SplitWords(known.words)); });
    place_ = begin;
    return is_next;
  }

  // Adds the next relation and its object to `described`. Returns what a further relation is about:
  // the first thing of the question, because only "that is" continues with the last one.
  AskedThing* AddCondition(AskedThing& first, AskedThing& described) {
    AskedCondition condition;
    const size_t begin = place_;
    const auto* const found = std::find_if(
        kRelationWords.begin(), kRelationWords.end(),
        [&](const RelationWords& known) { return TakePhrase(SplitWords(known.words)); });
    if (found == kRelationWords.end()) {
      Fail("a relation");
    }
    condition.relation = found->relation;
    condition.text = Text(begin);
    condition.other.push_back(ParseThing());
    described.conditions.push_back(std::move(condition));
    last_ = &described.conditions.back().other.front();
    return &first;
  }

  AskedThing ParseThing() {
    while (place_ < words_.size() && IsOneOf(kArticles, words_[place_])) {
      ++place_;
    }
    if (place_ == words_.size()) {
      throw InputError("the question ends too early, expected a class after '" + words_.back() +
                       "'");
    }
    const size_t begin = place_;
    AskedThing thing;
    const ClassMatch match = MatchClass(Rest(), labels_);
    if (match.words > 0) {
      thing.kind = ThingKind::kClass;
      thing.labels = match.labels;
      place_ += match.words;
    } else if (IsOneOf(kAnyThing, words_[place_])) {
      ++place_;
    } else if (TakeOne("floor") || TakeOne("ground")) {
      thing.kind = ThingKind::kFloor;
    } else if (TakeOne("surface") || TakeOne("surfaces")) {
      thing.kind = ThingKind::kSurface;
    } else if (TakeOne("object")) {
      thing.kind = ThingKind::kObject;
      thing.id = ParseId();
    } else {
      Fail("a class");
    }
    thing.text = Text(begin);
    return thing;
  }

  ObjectId ParseId() {
    uint32_t number = 0;
    const std::string word = place_ < words_.size() ? words_[place_] : std::string();
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) {
      throw InputError(fmt::format("'object {}': expected the number of an object", word));
    }
    ++place_;
    return ObjectId(number);
  }

  std::string Text(size_t begin) const {
    return fmt::format("{}", fmt::join(words_.begin() + static_cast<std::ptrdiff_t>(begin),
                                       words_.begin() + static_cast<std::ptrdiff_t>(place_), " "));
  }

  [[noreturn]] void Fail(const char* expected) const {
    const std::string word = place_ < words_.size() ? words_[place_] : std::string();
    Words relations;
    for (const RelationWords& known : kRelationWords) {
      relations.emplace_back(known.words);
    }
    std::string nearest;
    for (const std::string& label : labels_) {
      if (nearest.empty() || EditDistance(word, label) < EditDistance(word, nearest)) {
        nearest = label;
      }
    }
    const bool is_close = !nearest.empty() && IsMisspelt(word, nearest);
    throw InputError(fmt::format(
        "unknown word '{}', expected {}{}; classes: {}; other things: thing, object NUMBER, floor, "
        "surface; relations: {}",
        Printable(word), expected,
        is_close ? fmt::format(" (did you mean '{}'?)", Printable(nearest)) : "",
        Printable(fmt::format("{}", fmt::join(labels_, ", "))), fmt::join(relations, ", ")));
  }

  Words words_;
  const std::set<std::string>& labels_;
  size_t place_ = 0;
  AskedThing* last_ = nullptr;  // the object of the last relation
};

}  // namespace

AskedThing ParseQuestion(std::string_view text, const std::set<std::string>& labels) {
  return QuestionParser(SplitWords(text), labels).Parse();
}

}  // namespace hullslam

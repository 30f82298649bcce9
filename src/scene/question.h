// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/util/id.h"
#include "scene/scene.h"

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

// The relations in questions: the relations of a scene, their inverses, and the distance.
enum class AskedRelation {
  kOn,
  kUnder,  // the inverse of "on"
  kIn,
  kBeside,
  kInFrontOf,
  kBehind,  // the inverse of "in front of"
  kPartOf,
  kHiddenBy,
  kNear,
};

struct AskedThing;

struct AskedCondition {
  AskedRelation relation = AskedRelation::kNear;
  std::string text;               // the words of the question
  std::vector<AskedThing> other;  // exactly one
};

enum class ThingKind { kClass, kAny, kObject, kFloor, kSurface };

// One thing of a question: what it is, and what must hold for it.
struct AskedThing {
  ThingKind kind = ThingKind::kAny;
  std::set<std::string> labels;  // only kClass: one of these
  ObjectId id;                   // only kObject
  std::string text;              // the words of the question
  std::vector<AskedCondition> conditions;
};

// Reads a question in the grammar of docs/scene.md, such as "the cup on the table near the
// laptop". `labels` are the classes that exist. Throws InputError that names the word that was not
// understood and lists the words that are known.
AskedThing ParseQuestion(std::string_view text, const std::set<std::string>& labels);

}  // namespace hullslam

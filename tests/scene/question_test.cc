// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/question.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "hullslam/util/error.h"
#include "support/expect_error.h"

namespace hullslam {
namespace {

using Words = std::vector<std::string>;

TEST(SplitWords, AreSmallLettersWithoutSigns) {
  EXPECT_EQ(SplitWords("  The Cup, on: T-shirt "), (Words{"the", "cup", "on", "t", "shirt"}));
  EXPECT_EQ(SplitWords("Stuhl Größe"), (Words{"stuhl", "größe"}));
  EXPECT_TRUE(SplitWords("?!").empty());
}

TEST(MatchClass, TakesTheLongestLabel) {
  const std::set<std::string> labels = {"plant", "potted plant", "cup"};
  const ClassMatch match = MatchClass(Words{"potted", "plant", "on"}, labels);
  EXPECT_EQ(match.labels, std::set<std::string>{"potted plant"});
  EXPECT_EQ(match.words, 2U);
}

TEST(MatchClass, KnowsPlurals) {
  const std::set<std::string> labels = {"cup", "glass", "knife", "teddy bear", "berry", "mouse"};
  for (const char* word : {"cups", "glasses", "knives", "berries", "mice"}) {
    EXPECT_EQ(MatchClass(Words{word}, labels).words, 1U) << word;
  }
  EXPECT_EQ(MatchClass(Words{"teddy", "bears"}, labels).words, 2U);
  EXPECT_EQ(MatchClass(Words{"cupboard"}, labels).words, 0U);
}

TEST(MatchClass, TheLastWordAloneMeansAllLabelsThatEndWithIt) {
  const std::set<std::string> labels = {"potted plant", "sports ball", "tennis ball"};
  EXPECT_EQ(MatchClass(Words{"plants"}, labels).labels, std::set<std::string>{"potted plant"});
  EXPECT_EQ(MatchClass(Words{"ball", "near"}, labels).labels.size(), 2U);
  EXPECT_EQ(MatchClass(Words{"sports"}, labels).words, 0U);
  EXPECT_EQ(MatchClass({}, labels).words, 0U);
}

TEST(MatchClass, KnowsPluralsThatChangeTheWord) {
  const std::set<std::string> labels = {"shelf", "person", "box"};
  for (const char* word : {"shelves", "people", "boxes"}) {
    EXPECT_EQ(MatchClass(Words{word}, labels).words, 1U) << word;
  }
  EXPECT_EQ(MatchClass(Words{"boxe"}, labels).words, 0U);
}

const std::set<std::string> kLabels = {"cup", "book", "laptop", "dining table"};

TEST(ParseQuestion, AllRelationsAreAboutTheFirstThing) {
  const AskedThing cup = ParseQuestion("The cup on the table near a laptop", kLabels);
  EXPECT_EQ(cup.kind, ThingKind::kClass);
  EXPECT_EQ(cup.labels, std::set<std::string>{"cup"});
  ASSERT_EQ(cup.conditions.size(), 2U);
  EXPECT_EQ(cup.conditions[0].relation, AskedRelation::kOn);
  EXPECT_EQ(cup.conditions[0].other[0].labels, std::set<std::string>{"dining table"});
  EXPECT_EQ(cup.conditions[1].relation, AskedRelation::kNear);
  EXPECT_EQ(cup.conditions[1].other[0].text, "laptop");
}

TEST(ParseQuestion, ThatIsDescribesTheLastThing) {
  const AskedThing cup =
      ParseQuestion("cup next to the book that is on the laptop and near object 12", kLabels);
  ASSERT_EQ(cup.conditions.size(), 2U);
  const AskedThing& book = cup.conditions[0].other[0];
  ASSERT_EQ(book.conditions.size(), 1U);
  EXPECT_EQ(book.conditions[0].other[0].labels, std::set<std::string>{"laptop"});
  EXPECT_EQ(cup.conditions[1].other[0].kind, ThingKind::kObject);
  EXPECT_EQ(cup.conditions[1].other[0].id, ObjectId(12));
}

TEST(ParseQuestion, KnowsSynonymsAndThingsWithoutClass) {
  const AskedThing thing = ParseQuestion("something on top of the floor in front of it", {"it"});
  EXPECT_EQ(thing.kind, ThingKind::kAny);
  EXPECT_EQ(thing.conditions[0].relation, AskedRelation::kOn);
  EXPECT_EQ(thing.conditions[0].other[0].kind, ThingKind::kFloor);
  EXPECT_EQ(thing.conditions[1].relation, AskedRelation::kInFrontOf);
  EXPECT_EQ(ParseQuestion("book under the cup", kLabels).conditions[0].relation,
            AskedRelation::kUnder);
}

TEST(ParseQuestion, WordsThatOnlyOpenAQuestionAreSkipped) {
  for (const char* const question :
       {"is there a laptop?", "Are there any laptops?", "where is my laptop", "find the laptop",
        "show me all laptops", "which laptop", "What is the laptop"}) {
    const AskedThing thing = ParseQuestion(question, kLabels);
    EXPECT_EQ(thing.labels, std::set<std::string>{"laptop"}) << question;
    EXPECT_TRUE(thing.conditions.empty()) << question;
  }
  for (const char* const question : {"Is the cup on the book?", "which cups are on the book"}) {
    const AskedThing thing = ParseQuestion(question, kLabels);
    EXPECT_EQ(thing.labels, std::set<std::string>{"cup"}) << question;
    ASSERT_EQ(thing.conditions.size(), 1U) << question;
    EXPECT_EQ(thing.conditions[0].relation, AskedRelation::kOn) << question;
  }
  const AskedThing any = ParseQuestion("what is on the table?", kLabels);
  EXPECT_EQ(any.kind, ThingKind::kAny);
  EXPECT_EQ(any.conditions.at(0).other.at(0).labels, std::set<std::string>{"dining table"});
  // A class may have the name of such a word.
  EXPECT_EQ(ParseQuestion("show", {"show"}).kind, ThingKind::kClass);
}

// "Is" is not a misspelt "tv".
TEST(ParseQuestion, OnlySimilarWordsAreSuggested) {
  const auto message = [](const char* question, const std::set<std::string>& labels) {
    try {
      ParseQuestion(question, labels);
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_NE(message("is there a tw", {"cup", "tv"}).find("did you mean 'tv'?"), std::string::npos);
  EXPECT_EQ(message("is there a pa", {"cup", "tv"}).find("did you mean"), std::string::npos);
}

TEST(ParseQuestion, UnknownWordsNameTheKnownOnes) {
  ExpectInputError([] { ParseQuestion("zebra", kLabels); },
                   {"unknown word 'zebra'", "book, cup, dining table, laptop", "next to"});
  ExpectInputError([] { ParseQuestion("cup on labtop", kLabels); }, {"did you mean 'laptop'?"});
  ExpectInputError([] { ParseQuestion("cup above book", kLabels); }, {"'above'", "a relation"});
  ExpectInputError([] { ParseQuestion("cup on the", kLabels); }, {"ends too early", "'the'"});
  ExpectInputError([] { ParseQuestion(" ? ", kLabels); }, {"no word"});
  ExpectInputError([] { ParseQuestion("object x", kLabels); }, {"'object x'", "number"});
  ExpectInputError([] { ParseQuestion("cup that on book", kLabels); }, {"'on'", "'is'"});
}

TEST(ParseQuestion, UnknownWordsAndLabelsAreMadePrintable) {
  ExpectInputError([] { ParseQuestion("x\xff\x1b", {"a\nb<b>"}); }, {"<b>"});
}

TEST(ParseQuestion, EachWordHasItsRelation) {
  const std::vector<std::pair<const char*, AskedRelation>> relations = {
      {"in front of", AskedRelation::kInFrontOf},
      {"on top of", AskedRelation::kOn},
      {"standing on", AskedRelation::kOn},
      {"lying on", AskedRelation::kOn},
      {"upon", AskedRelation::kOn},
      {"next to", AskedRelation::kBeside},
      {"beside", AskedRelation::kBeside},
      {"close to", AskedRelation::kNear},
      {"by", AskedRelation::kNear},
      {"near", AskedRelation::kNear},
      {"part of", AskedRelation::kPartOf},
      {"hidden by", AskedRelation::kHiddenBy},
      {"inside of", AskedRelation::kIn},
      {"inside", AskedRelation::kIn},
      {"in", AskedRelation::kIn},
      {"below", AskedRelation::kUnder},
      {"beneath", AskedRelation::kUnder},
      {"supporting", AskedRelation::kUnder},
      {"supports", AskedRelation::kUnder},
      {"behind", AskedRelation::kBehind}};
  for (const auto& [words, relation] : relations) {
    const AskedThing cup = ParseQuestion(std::string("cup ") + words + " some book", kLabels);
    ASSERT_EQ(cup.conditions.size(), 1U) << words;
    EXPECT_EQ(cup.conditions[0].relation, relation) << words;
    EXPECT_EQ(cup.conditions[0].text, words);
  }
}

}  // namespace

}  // namespace hullslam

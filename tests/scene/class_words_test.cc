// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/class_words.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hullslam

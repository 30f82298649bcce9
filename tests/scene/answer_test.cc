// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/answer.h"

#include <gtest/gtest.h>

#include "scene/made_scene.h"
#include "support/expect_error.h"

namespace hullslam {
namespace {

std::vector<uint32_t> Ask(const Scene& scene, const std::string& question) {
  std::set<std::string> labels;
  for (const SceneObject& object : scene.objects) {
    for (const auto& [label, share] : object.shares) {
      labels.insert(label);
    }
  }
  std::vector<uint32_t> ids;
  for (const Answer& answer : AnswerQuestion(scene, ParseQuestion(question, labels))) {
    ids.push_back(answer.object.value);
  }
  return ids;
}

using Ids = std::vector<uint32_t>;

TEST(AnswerQuestion, RanksByVotesAndRelations) {
  const Scene scene = MakeQueryScene();
  EXPECT_EQ(Ask(scene, "cups"), (Ids{0, 2}));
  EXPECT_EQ(Ask(scene, "bowl"), (Ids{2}));
  EXPECT_EQ(Ask(scene, "cup on the book"), (Ids{0}));
  EXPECT_EQ(Ask(scene, "book under the cup"), (Ids{3}));
  EXPECT_EQ(Ask(scene, "cup next to a book"), (Ids{2, 0})) << "the second one is only near";
  EXPECT_TRUE(Ask(scene, "laptop next to a book").empty());
  EXPECT_EQ(Ask(scene, "thing on the floor"), (Ids{8}));
  EXPECT_EQ(Ask(scene, "cup on a surface"), (Ids{2}));
  EXPECT_EQ(Ask(scene, "cup near the book"), (Ids{0, 2}));
  EXPECT_EQ(Ask(scene, "cup near the book that is under object 0"), (Ids{0, 2}));
  EXPECT_TRUE(Ask(scene, "laptop on the book").empty());
}

TEST(AnswerQuestion, TellsWhy) {
  const Scene scene = MakeQueryScene();
  const auto answers = AnswerQuestion(scene, ParseQuestion("cup on book", {"cup", "book"}));
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].score, 1.0);
  EXPECT_EQ(answers[0].reason,
            "cup 0 (100 % of the votes), on book 3 (100 % of the votes) (gap 0.001)");
}

TEST(AnswerQuestion, RefusesWhatItCannotKnow) {
  Scene scene = MakeQueryScene();
  ExpectInputError([&] { Ask(scene, "cup on object 77"); }, {"object 77"});
  ExpectInputError([&] { Ask(scene, "floor"); }, {"'floor'", "on"});
  scene.up.reset();
  scene.up_from = "unknown: too few landmarks";
  ExpectInputError([&] { Ask(scene, "cup on book"); }, {"'on'", "too few landmarks"});
  EXPECT_EQ(Ask(scene, "cup near book"), (Ids{0, 2}));
}

TEST(FindWithin, GivesTheNearestFirst) {
  const Scene scene = MakeQueryScene();
  const auto answers = FindWithin(scene, {"cup"}, 0.2, ObjectId(3));
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].object, ObjectId(0));
  EXPECT_EQ(answers[1].object, ObjectId(2));
  EXPECT_EQ(FindWithin(scene, {}, 0.2, ObjectId(3)).size(), 2U);
  ExpectInputError([&] { FindWithin(scene, {}, 1.0, ObjectId(4)); }, {"object 4"});
}

TEST(FindLike, GivesTheSameClassAndSizeFirst) {
  const auto answers = FindLike(MakeQueryScene(), ObjectId(0));
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].object, ObjectId(2));
  EXPECT_NEAR(answers[0].score, 0.8, 1e-9);
}

TEST(FindByEmbedding, GivesTheSmallestAngleFirst) {
  Scene scene = MakeQueryScene();
  EXPECT_THROW(FindByEmbedding(scene, std::vector{1.0f}), InputError) << "no object has a vector";
  scene.objects[0].embedding = {0.0f, 1.0f};
  scene.objects[2].embedding = {0.6f, 0.8f};
  scene.objects[3].embedding = {-1.0f, 0.0f};
  const std::vector<Answer> answers = FindByEmbedding(scene, std::vector{5.0f, 0.0f});
  ASSERT_EQ(answers.size(), 1U) << "the others are at right angles or opposite";
  EXPECT_EQ(answers[0].object, scene.objects[2].id);
  EXPECT_NEAR(answers[0].score, 0.6, 1e-6);
  ExpectInputError(
      [&] {
        FindByEmbedding(scene, std::vector{1.0f, 0.0f, 0.0f});
      },
      {"3 number(s)", "expected 2"});
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/answer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

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

// The score of an object for a question; 0 if it is not among the answers.
double ScoreOf(const Scene& scene, const std::string& question, uint32_t id) {
  for (const Answer& answer :
       AnswerQuestion(scene, ParseQuestion(question, {"cup", "bowl", "book", "laptop"}))) {
    if (answer.object == ObjectId(id)) {
      return answer.score;
    }
  }
  return 0.0;
}

// The centres of cup 2 and the book are sqrt(0.09 + 0.0009) m apart, so the gap is that less the
// radii of 0.05 and 0.1 m. Extents are diameters.
TEST(AnswerQuestion, NearnessFallsWithTheGapInSizes) {
  const Scene scene = MakeQueryScene();
  const double share = (std::sqrt(0.0909) - 0.15) / 0.15;
  EXPECT_NEAR(ScoreOf(scene, "cup near book", 2), 0.8 / (1.0 + share * share), 1e-3);
  EXPECT_EQ(ScoreOf(scene, "cup near book", 0), 1.0) << "they touch";
  EXPECT_EQ(ScoreOf(scene, "cup next to book", 0), 0.5) << "almost beside it";
  EXPECT_EQ(ScoreOf(scene, "cup next to book", 2), 0.8);
}

TEST(AnswerQuestion, KnowsEachRelationInItsDirection) {
  const std::vector<std::tuple<RelationKind, const char*, const char*>> asked = {
      {RelationKind::kIn, "in", ""},
      {RelationKind::kOn, "on", "under"},
      {RelationKind::kPartOf, "part of", ""},
      {RelationKind::kInFrontOf, "in front of", "behind"},
      {RelationKind::kHiddenBy, "hidden by", ""}};
  for (const auto& [kind, forward, backward] : asked) {
    Scene scene = MakeQueryScene();
    scene.relations = {{ObjectId(0), kind, ObjectId(5), {}}};
    EXPECT_EQ(Ask(scene, std::string("cup ") + forward + " the laptop"), Ids{0}) << forward;
    EXPECT_EQ(Ask(scene, std::string("laptop ") + forward + " the cup"), Ids()) << forward;
    if (*backward != 0) {
      EXPECT_EQ(Ask(scene, std::string("laptop ") + backward + " the cup"), Ids{5}) << backward;
      EXPECT_EQ(Ask(scene, std::string("cup ") + backward + " the laptop"), Ids()) << backward;
    }
  }
}

TEST(AnswerQuestion, OnlyRelationsOfViewsDoNotNeedTheUpwardDirection) {
  Scene scene = MakeQueryScene();
  scene.up.reset();
  scene.up_from = "unknown";
  for (const char* relation : {"on", "under", "in", "next to", "part of"}) {
    ExpectInputError([&] { Ask(scene, std::string("cup ") + relation + " book"); }, {relation});
  }
  for (const char* relation : {"in front of", "behind", "hidden by", "near"}) {
    EXPECT_NO_THROW(Ask(scene, std::string("cup ") + relation + " book")) << relation;
  }
}

TEST(FindWithin, TheScoreFallsToItsLeastValueAtTheDistance) {
  const Scene scene = MakeQueryScene();
  const double gap = std::sqrt(0.0909) - 0.15;
  const auto answers = FindWithin(scene, {"cup"}, 0.2, ObjectId(3));
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].score, 1.0) << "they touch";
  EXPECT_NEAR(answers[1].score, 0.8 * (1.0 - 0.9 * gap / 0.2), 1e-3);
  EXPECT_EQ(FindWithin(scene, {}, 1.001 * gap, ObjectId(3)).size(), 2U);
  EXPECT_EQ(FindWithin(scene, {}, 0.98 * gap, ObjectId(3)).size(), 1U);
}

TEST(FindLike, ComparesAxesInAnyOrderAsRatios) {
  Scene scene = MakeQueryScene();
  scene.objects[0].ellipsoid.half_axes = {0.1, 0.2, 0.4};
  scene.objects[1].ellipsoid.half_axes = {0.4, 0.1, 0.2};
  EXPECT_NEAR(FindLike(scene, ObjectId(0)).at(0).score, 0.8, 1e-9);
  scene.objects[1].ellipsoid.half_axes *= 2.0;
  EXPECT_NEAR(FindLike(scene, ObjectId(0)).at(0).score, 0.4, 1e-9);
  EXPECT_NEAR(FindLike(scene, ObjectId(2)).at(0).score, 0.4, 1e-9) << "in either order";
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/relations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scene/made_scene.h"

namespace hullslam {
namespace {

// The relations of upright ellipsoids that were all seen together, as "0 on 1".
std::vector<std::string> Describe(const std::vector<MadeObject>& objects) {
  std::vector<ObjectBody> bodies;
  ObservationStatistics observations;
  for (uint32_t i = 0; i < objects.size(); ++i) {
    bodies.push_back(
        BodyOfEllipsoid(ObjectId(i), objects[i].ellipsoid, Eigen::Quaterniond::Identity()));
    for (uint32_t k = 0; k < objects.size(); ++k) {
      observations.joint[{ObjectId(i), ObjectId(k)}].observations = 5;
    }
  }
  std::vector<std::string> texts;
  for (const Relation& relation : FindStandingRelations(bodies, observations).relations) {
    texts.push_back(std::to_string(relation.subject.value) + " " +
                    std::string(ToString(relation.kind)) + " " +
                    std::to_string(relation.object.value));
  }
  return texts;
}

using Texts = std::vector<std::string>;

TEST(StandingRelations, ABookOnABook) {
  EXPECT_EQ(Describe({Standing("book", {0.0, 0.0, 0.04}, {0.1, 0.13, 0.02}),
                      Standing("book", {0.01, 0.0, 0.0}, {0.1, 0.13, 0.02})}),
            (Texts{"0 on 1", "1 supports 0"}));
}

TEST(StandingRelations, ThingsOfOneHeightThatAreNearAreBesideEachOther) {
  EXPECT_EQ(Describe({Standing("cup", {0.0, 0.0, 0.0}, {0.05, 0.05, 0.05}),
                      Standing("cup", {0.15, 0.0, 0.0}, {0.05, 0.05, 0.05})}),
            (Texts{"0 beside 1", "1 beside 0"}));
  EXPECT_EQ(Describe({Standing("cup", {0.0, 0.0, 0.0}, {0.05, 0.05, 0.05}),
                      Standing("cup", {0.25, 0.0, 0.0}, {0.05, 0.05, 0.05})}),
            Texts());
}

TEST(StandingRelations, AFruitThatLooksOutOfABowlIsInIt) {
  EXPECT_EQ(Describe({Standing("apple", {0.0, 0.0, 0.01}, {0.04, 0.04, 0.04}),
                      Standing("bowl", {0.0, 0.0, 0.0}, {0.12, 0.12, 0.05})}),
            (Texts{"0 in 1"}));
}

TEST(StandingRelations, APictureAboveABedIsNotOnIt) {
  EXPECT_EQ(Describe({Standing("clock", {0.0, 0.0, 1.5}, {0.1, 0.1, 0.1}),
                      Standing("bed", {0.0, 0.0, 0.0}, {1.0, 0.5, 0.25})}),
            Texts());
}

// What begins in the lowest third of a thing is not on it, and so no higher thing carries a lower.
TEST(StandingRelations, NothingIsCarriedByAThingThatBeginsHigherUp) {
  const auto is_on = [](double bottom) {
    const Texts texts = Describe({Standing("box", {0.0, 0.0, bottom}, {0.1, 0.1, 0.05}),
                                  Standing("box", {0.0, 0.0, 0.0}, {0.1, 0.1, 0.05})});
    return std::find(texts.begin(), texts.end(), "0 on 1") != texts.end();
  };
  EXPECT_TRUE(is_on(0.1));
  EXPECT_TRUE(is_on(0.035));
  EXPECT_FALSE(is_on(0.031));
  EXPECT_FALSE(is_on(-0.02));
  EXPECT_FALSE(is_on(0.2)) << "there is a gap";
}

TEST(StandingRelations, OfTwoCarriersTheOneWithTheNearestTopCounts) {
  const Texts texts = Describe({Standing("cup", {0.0, 0.0, 0.08}, {0.05, 0.05, 0.05}),
                                Standing("box", {0.0, 0.0, 0.0}, {0.1, 0.1, 0.06}),
                                Standing("book", {0.0, 0.0, 0.041}, {0.1, 0.1, 0.02})});
  EXPECT_NE(std::find(texts.begin(), texts.end(), "0 on 2"), texts.end());
  EXPECT_EQ(std::find(texts.begin(), texts.end(), "0 on 1"), texts.end());
}

TEST(ViewRelations, NeedEnoughViewsAndTellTheirShare) {
  ObservationStatistics observations;
  observations.joint[{ObjectId(1), ObjectId(2)}] = {
      .observations = 10, .in_front = 6, .mask_inside = 0};
  observations.joint[{ObjectId(1), ObjectId(3)}] = {
      .observations = 2, .in_front = 2, .mask_inside = 0};
  observations.hidden[{ObjectId(2), ObjectId(1)}] = {.observations = 10, .hidden = 4, .most = 0.7};
  const std::vector<Relation> relations = FindObservedRelations(observations);
  ASSERT_EQ(relations.size(), 2U);
  EXPECT_EQ(relations[0].kind, RelationKind::kInFrontOf);
  EXPECT_EQ(relations[0].object, ObjectId(2));
  EXPECT_EQ(relations[0].evidence, (Evidence{{"views", 10.0}, {"share", 0.6}}));
  EXPECT_EQ(relations[1].kind, RelationKind::kHiddenBy);
  EXPECT_EQ(relations[1].subject, ObjectId(2));
}

// The relations of a knob and the door that it is in or on, if the knob's mask was inside the
// door's in so many of the common observations.
Texts RelationsOfAKnob(size_t observations, size_t inside) {
  const std::vector<MadeObject> objects = {Standing("knob", {0.0, 0.0, 0.6}, {0.03, 0.03, 0.03}),
                                           Standing("door", {0.0, 0.0, 0.0}, {0.4, 0.4, 0.5})};
  ObservationStatistics statistics;
  statistics.joint[{ObjectId(0), ObjectId(1)}] = {.observations = observations,
                                                  .mask_inside = inside};
  std::vector<ObjectBody> bodies;
  for (uint32_t i = 0; i < 2; ++i) {
    bodies.push_back(
        BodyOfEllipsoid(ObjectId(i), objects[i].ellipsoid, Eigen::Quaterniond::Identity()));
  }
  Texts texts;
  for (const Relation& relation : FindStandingRelations(bodies, statistics).relations) {
    texts.emplace_back(ToString(relation.kind));
  }
  return texts;
}

TEST(StandingRelations, APartWasSeenInsideInHalfOfAtLeastThreeViews) {
  EXPECT_EQ(RelationsOfAKnob(4, 2), Texts{"part of"});
  EXPECT_EQ(RelationsOfAKnob(3, 3), Texts{"part of"});
  EXPECT_EQ(RelationsOfAKnob(4, 1), (Texts{"on", "supports"})) << "seldom inside";
  EXPECT_EQ(RelationsOfAKnob(2, 2), (Texts{"on", "supports"})) << "seldom seen";
}

// Two discs of one radius r whose centres are 0.6 r and r apart have 62 % and 39 % in common.
TEST(StandingRelations, HalfOfTheFootprintMustBeOnTheCarrier) {
  const auto is_on = [](double aside) {
    const Texts texts = Describe({Standing("box", {aside, 0.0, 0.1}, {0.1, 0.1, 0.05}),
                                  Standing("box", {0.0, 0.0, 0.0}, {0.1, 0.1, 0.05})});
    return std::find(texts.begin(), texts.end(), "0 on 1") != texts.end();
  };
  EXPECT_TRUE(is_on(0.06));
  EXPECT_FALSE(is_on(0.1));
}

// Both begin at the height of the bowl. Half of the ball is in the bowl if its centre is on the
// rim.
TEST(StandingRelations, HalfOfTheVolumeMustBeInside) {
  const auto is_in = [](double aside) {
    const Texts texts = Describe({Standing("ball", {aside, 0.0, 0.3}, {0.05, 0.05, 0.05}),
                                  Standing("bowl", {0.0, 0.0, 0.0}, {0.5, 0.5, 0.5})});
    return std::find(texts.begin(), texts.end(), "0 in 1") != texts.end();
  };
  // The ball's centre is 0.15 m below that of the bowl, so the rim is at sqrt(0.25 - 0.0225).
  const double rim = std::sqrt(0.25 - 0.0225);
  EXPECT_TRUE(is_in(rim - 0.02));
  EXPECT_FALSE(is_in(rim + 0.01));
}

TEST(StandingRelations, ThingsOnOneThingAreBesideEachOther) {
  const Texts texts = Describe({Standing("cup", {0.0, 0.0, 0.2}, {0.05, 0.05, 0.05}),
                                Standing("cup", {0.15, 0.0, 0.2}, {0.05, 0.05, 0.05}),
                                Standing("box", {0.0, 0.0, 0.0}, {0.5, 0.5, 0.1}),
                                Standing("cup", {0.55, 0.0, 0.0}, {0.05, 0.05, 0.05})});
  const auto has = [&](const char* text) {
    return std::find(texts.begin(), texts.end(), text) != texts.end();
  };
  EXPECT_TRUE(has("0 on 2"));
  EXPECT_TRUE(has("0 beside 1"));
  EXPECT_TRUE(has("1 beside 0"));
  EXPECT_FALSE(has("1 beside 3")) << "one is on the box, the other on the floor";
}

TEST(ViewRelations, TooFewViewsOrATooSmallShareAreNoRelation) {
  const auto count = [](const JointObservations& joint, const HiddenCounts& hidden) {
    ObservationStatistics observations;
    observations.joint[{ObjectId(1), ObjectId(2)}] = joint;
    observations.hidden[{ObjectId(1), ObjectId(2)}] = hidden;
    return FindObservedRelations(observations).size();
  };
  const JointObservations no_joint = {.observations = 9, .in_front = 0};
  const HiddenCounts no_hidden = {.observations = 9, .hidden = 0};
  EXPECT_EQ(count({.observations = 3, .in_front = 2}, no_hidden), 1U);
  EXPECT_EQ(count({.observations = 10, .in_front = 5}, no_hidden), 1U);
  EXPECT_EQ(count({.observations = 10, .in_front = 4}, no_hidden), 0U);
  EXPECT_EQ(count(no_joint, {.observations = 12, .hidden = 3}), 1U);
  EXPECT_EQ(count(no_joint, {.observations = 13, .hidden = 3}), 0U);
  EXPECT_EQ(count(no_joint, {.observations = 2, .hidden = 2}), 0U);
}

}  // namespace
}  // namespace hullslam

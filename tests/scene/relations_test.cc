// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/relations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scene/made_scene.h"

namespace hullslam {
namespace {

// The relations of upright ellipsoids that were all seen together, as "0 on 1".
std::vector<std::string> Describe(const std::vector<MadeObject>& objects) {
  std::vector<ObjectBody> bodies;
  ViewStatistics views;
  for (uint32_t i = 0; i < objects.size(); ++i) {
    bodies.push_back(
        BodyOfEllipsoid(ObjectId(i), objects[i].ellipsoid, Eigen::Quaterniond::Identity()));
    for (uint32_t k = 0; k < objects.size(); ++k) {
      views.joint[{ObjectId(i), ObjectId(k)}].views = 5;
    }
  }
  std::vector<std::string> texts;
  for (const Relation& relation : FindStandingRelations(bodies, views).relations) {
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
  ViewStatistics views;
  views.joint[{ObjectId(1), ObjectId(2)}] = {.views = 10, .in_front = 6, .mask_inside = 0};
  views.joint[{ObjectId(1), ObjectId(3)}] = {.views = 2, .in_front = 2, .mask_inside = 0};
  views.hidden[{ObjectId(2), ObjectId(1)}] = {.views = 10, .hidden = 4, .most = 0.7};
  const std::vector<Relation> relations = FindViewRelations(views);
  ASSERT_EQ(relations.size(), 2U);
  EXPECT_EQ(relations[0].kind, RelationKind::kInFrontOf);
  EXPECT_EQ(relations[0].object, ObjectId(2));
  EXPECT_EQ(relations[0].evidence, (Evidence{{"views", 10.0}, {"share", 0.6}}));
  EXPECT_EQ(relations[1].kind, RelationKind::kHiddenBy);
  EXPECT_EQ(relations[1].subject, ObjectId(2));
}

}  // namespace
}  // namespace hullslam

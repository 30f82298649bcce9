// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/object_votes.h"

#include <gtest/gtest.h>

#include "loop/ring_things.h"

namespace hullslam {
namespace {

// The votes in a map without drift, which is like a map after the correction.
ObjectVotes Votes(const std::vector<RingThing>& things) {
  const RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()}, things);
  return CountObjectVotes(made.map, SharedRing().sensor(), KeyframeId(29), KeyframeId(5), {});
}

void ExpectVotes(const std::vector<RingThing>& things, int agree, int disagree) {
  const ObjectVotes votes = Votes(things);
  EXPECT_EQ(votes.agree, agree);
  EXPECT_EQ(votes.disagree, disagree);
}

TEST(ObjectVotes, TheSameThingsAgree) {
  ExpectVotes(ThreeThings(), 3, 0);
  ExpectVotes({}, 0, 0);
}

TEST(ObjectVotes, AThingThatOneEndDoesNotSeeDisagreesInBothDirections) {
  std::vector<RingThing> things = ThreeThings();
  things[0].is_at_last = false;
  ExpectVotes(things, 2, 1);
  things[1].is_at_first = false;
  ExpectVotes(things, 1, 2);
}

// Each of the two ends has an object whose place is taken by one of another class.
TEST(ObjectVotes, OtherClassesAtTheSamePlaceDisagree) {
  std::vector<RingThing> things = ThreeThings();
  things[0].is_at_last = false;
  things.push_back({ThingAt("vase", 5.0 / 24.0, -0.7)});
  things.back().is_at_first = false;
  ExpectVotes(things, 2, 2);
}

// A detector may call one thing by two names: it is enough that they share one of them.
TEST(ObjectVotes, OneCommonClassIsEnough) {
  std::vector<RingThing> things = ThreeThings();
  things[0].is_at_last = false;
  things.push_back({ThingAt("vase", 5.0 / 24.0, -0.7)});
  things.back().is_at_first = false;
  RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()}, things);
  const ObjectId vase(made.map.objects().NextId().value - 1);  // it was added last
  ASSERT_EQ(made.map.objects().At(vase).Label(), "vase");
  made.map.MutableObject(vase).votes["cup"] = 0.1;
  const ObjectVotes votes =
      CountObjectVotes(made.map, SharedRing().sensor(), KeyframeId(29), KeyframeId(5), {});
  EXPECT_EQ(votes.agree, 3);
  EXPECT_EQ(votes.disagree, 0);
}

// Objects that the other end could not have seen do not vote.
TEST(ObjectVotes, ThingsOutsideTheOtherImageDoNotVote) {
  std::vector<RingThing> things = ThreeThings();
  things.push_back({ThingAt("lamp", 2.0 / 24.0, 0.0)});  // keyframe 5 looks past it by 45 degrees
  things.back().is_at_last = false;
  ExpectVotes(things, 3, 0);
}

// The shape of a candidate is not known.
TEST(ObjectVotes, CandidatesDoNotVote) {
  RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()}, ThreeThings());
  made.map.MutableObject(ObjectId(0)).state = ObjectState::kCandidate;
  const ObjectVotes votes =
      CountObjectVotes(made.map, SharedRing().sensor(), KeyframeId(29), KeyframeId(5), {});
  EXPECT_EQ(votes.agree, 2);
}

// An object is mapped only after several views. Until then its masks show that it is there.
TEST(ObjectVotes, AThingThatIsNotMappedYetIsNotMissing) {
  RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()}, ThreeThings());
  const auto votes = [&] {
    return CountObjectVotes(made.map, SharedRing().sensor(), KeyframeId(29), KeyframeId(5), {});
  };
  made.map.MutableObject(ObjectId(3)).state = ObjectState::kCandidate;  // the cup of the last turn
  EXPECT_EQ(votes().agree, 2);
  EXPECT_EQ(votes().disagree, 0);
  made.map.MutableObject(ObjectId(0)).votes = {{"vase", 1.0}};
  EXPECT_EQ(votes().disagree, 1) << "the other end shows another thing there";
}

// If the loop were wrong by more than their size, the things would be beside each other.
TEST(ObjectVotes, ThingsBesideEachOtherDisagree) {
  const RingMap made =
      MakeRingMap(SharedRing(), {.drift = Rigid3(Eigen::Quaterniond::Identity(), {0.0, 0.5, 0.0})},
                  ThreeThings());
  const ObjectVotes votes =
      CountObjectVotes(made.map, SharedRing().sensor(), KeyframeId(29), KeyframeId(5), {});
  EXPECT_EQ(votes.agree, 0);
  EXPECT_GE(votes.disagree, 2);
  EXPECT_TRUE(votes.IsAgainst());
}

TEST(ObjectVotes, SeveralVotesAreNeededAndTheMajorityDecides) {
  const auto is_for = [](int agree, int disagree) { return ObjectVotes{agree, disagree}.IsFor(); };
  const auto is_against = [](int agree, int disagree) {
    return ObjectVotes{agree, disagree}.IsAgainst();
  };
  EXPECT_FALSE(is_for(1, 0));
  EXPECT_TRUE(is_for(2, 1));
  EXPECT_FALSE(is_for(2, 2));
  EXPECT_FALSE(is_against(0, 1)) << "a single one may have been moved";
  EXPECT_TRUE(is_against(1, 2));
  EXPECT_FALSE(is_against(2, 2));
  for (int agree = 0; agree < 6; ++agree) {
    for (int disagree = 0; disagree < 6; ++disagree) {
      EXPECT_FALSE(is_for(agree, disagree) && is_against(agree, disagree));
      EXPECT_EQ(is_for(agree, disagree), is_against(disagree, agree));
    }
  }
}

// Enlarged by half, each must contain the centre of the other.
TEST(ObjectVotes, ThingsAreAtOneLocationUpToOneAndAHalfOfTheirHalfAxes) {
  const auto agreeing = [](double half_axes) {
    RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()}, ThreeThings());
    ObjectLandmark& cup = made.map.MutableObject(ObjectId(3));  // of the last turn
    const Eigen::Vector3d along =
        cup.ellipsoid.world_from_object.rotation * Eigen::Vector3d::UnitX();
    cup.ellipsoid.world_from_object.translation += half_axes * cup.ellipsoid.half_axes.x() * along;
    return CountObjectVotes(made.map, SharedRing().sensor(), KeyframeId(29), KeyframeId(5), {})
        .agree;
  };
  EXPECT_EQ(agreeing(1.45), 3);
  EXPECT_EQ(agreeing(1.55), 2);
}

}  // namespace
}  // namespace hullslam

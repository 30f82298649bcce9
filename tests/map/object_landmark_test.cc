// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/object_landmark.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hullslam/map/map.h"
#include "hullslam/util/check.h"
#include "map/made_map.h"

namespace hullslam {
namespace {

TEST(ObjectLandmark, IsACandidateWithoutShapeAtFirst) {
  const ObjectLandmark object;
  EXPECT_EQ(object.state, ObjectState::kCandidate);
  EXPECT_FALSE(object.has_shape);
  EXPECT_THROW(object.Label(), CheckError);
}

TEST(ObjectState, HasANameForMessages) {
  EXPECT_EQ(ToString(ObjectState::kCandidate), "candidate");
  EXPECT_EQ(ToString(ObjectState::kMapped), "mapped");
}

TEST(ObjectLandmark, HasTheClassWithMostVotes) {
  ObjectLandmark object;
  object.votes = {{"laptop", 0.9}, {"tv", 1.4}};
  EXPECT_EQ(object.Label(), "tv");
  object.votes["laptop"] = 1.4;
  EXPECT_EQ(object.Label(), "laptop");  // a tie goes to the first in the alphabet
}

TEST(ObjectsOfTheMap, KnowTheirObservationsAndVotes) {
  Map map;
  const KeyframeId a = AddKeyframe(map, 1);
  const KeyframeId b = AddKeyframe(map, 1);
  const ObjectId object = map.AddObject();
  EXPECT_TRUE(map.AddObservation(object, b, 0));
  EXPECT_TRUE(map.AddObservation(object, a, 3));
  EXPECT_FALSE(map.AddObservation(object, a, 2));  // one observation per keyframe
  EXPECT_FALSE(map.AddObservation(map.AddObject(), a, 3));
  const ObjectLandmark& seen = map.objects().At(object);
  ASSERT_EQ(seen.observations.size(), 2u);
  EXPECT_EQ(seen.observations[0].keyframe, a);
  EXPECT_EQ(seen.observations[0].detection, 3u);
  EXPECT_EQ(map.keyframes().At(a).objects[3], object);
  EXPECT_DOUBLE_EQ(seen.votes.at("cup"), 0.3);
  EXPECT_DOUBLE_EQ(seen.votes.at("book"), 0.6);
  map.RemoveObservation(object, a);
  EXPECT_FALSE(map.keyframes().At(a).objects[3].IsValid());
  EXPECT_EQ(map.objects().At(object).votes.count("book"), 0u);
}

TEST(ObjectsOfTheMap, ReplacingMovesObservationsAndRedirectsTheId) {
  Map map;
  const KeyframeId a = AddKeyframe(map, 1);
  const KeyframeId b = AddKeyframe(map, 1);
  const ObjectId first = map.AddObject();
  const ObjectId second = map.AddObject();
  map.AddObservation(first, a, 0);
  map.AddObservation(second, b, 2);
  map.MutableObject(second).visible = 5;
  map.ReplaceObject(second, first);
  EXPECT_EQ(map.Resolve(second), first);
  EXPECT_EQ(map.keyframes().At(b).objects[2], first);
  EXPECT_EQ(map.objects().At(first).visible, 5);
  EXPECT_DOUBLE_EQ(map.objects().At(first).votes.at("cup"), 0.3 + 0.5);
  map.EraseObject(first);
  EXPECT_FALSE(map.Resolve(second).IsValid());
  EXPECT_FALSE(map.keyframes().At(a).objects[0].IsValid());
}

TEST(ObjectsOfTheMap, LoseTheObservationsOfACulledKeyframe) {
  Map map;
  AddKeyframe(map, 1);
  const KeyframeId b = AddKeyframe(map, 1);
  map.MutableKeyframe(KeyframeId(0)).children.push_back(b);
  map.MutableKeyframe(b).parent = KeyframeId(0);
  const ObjectId object = map.AddObject();
  map.AddObservation(object, b, 1);
  map.CullKeyframe(b);
  EXPECT_TRUE(map.objects().At(object).observations.empty());
  EXPECT_EQ(map.objects().At(object).reference, b);  // it has a pose although it is culled
}

TEST(ObjectsOfTheMap, ReferToTheFirstKeyframeThatObservesThem) {
  Map map;
  const KeyframeId a = AddKeyframe(map, 1);
  const KeyframeId b = AddKeyframe(map, 1);
  const ObjectId object = map.AddObject();
  EXPECT_FALSE(map.objects().At(object).reference.IsValid());
  map.AddObservation(object, b, 0);
  EXPECT_EQ(map.objects().At(object).reference, b);
  map.AddObservation(object, a, 0);
  EXPECT_EQ(map.objects().At(object).reference, a);
  map.RemoveObservation(object, a);
  EXPECT_EQ(map.objects().At(object).reference, b);
}

TEST(ObjectLandmark, ANameIsShortTextWithoutControlCharacters) {
  EXPECT_TRUE(ObjectLandmark::IsName(""));
  EXPECT_TRUE(
      ObjectLandmark::IsName("Grandma's \xc3\xbc"
                             "berall"));
  EXPECT_TRUE(ObjectLandmark::IsName(std::string(100, 'a')));
  EXPECT_FALSE(ObjectLandmark::IsName(std::string(101, 'a')));
  EXPECT_FALSE(ObjectLandmark::IsName("two\nlines"));
  EXPECT_FALSE(ObjectLandmark::IsName("\xff"));
}

TEST(ObjectLandmark, ASizeIsFromOneMillimetreToAHundredMetres) {
  EXPECT_TRUE(ObjectLandmark::IsSize(0.001));
  EXPECT_TRUE(ObjectLandmark::IsSize(100.0));
  for (const double wrong : {0.0, -0.5, 0.0009, 100.1, std::nan(""), HUGE_VAL}) {
    EXPECT_FALSE(ObjectLandmark::IsSize(wrong)) << wrong;
  }
}

TEST(ObjectLandmark, IsFixedOnceItIsLockedAndMapped) {
  ObjectLandmark object;
  object.is_locked = true;
  EXPECT_FALSE(object.IsFixed());
  object.state = ObjectState::kMapped;
  EXPECT_TRUE(object.IsFixed());
}

TEST(ObjectsOfTheMap, HandTheirNameLockAndSizeToTheObjectThatReplacesThem) {
  Map map;
  const ObjectId a = map.AddObject();
  const ObjectId b = map.AddObject();
  const ObjectId c = map.AddObject();
  map.MutableObject(a).name = "mine";
  map.MutableObject(a).is_locked = true;
  map.MutableObject(a).known_size = 0.5;
  map.ReplaceObject(a, b);
  EXPECT_EQ(map.objects().At(b).name, "mine");
  EXPECT_EQ(map.objects().At(b).known_size, 0.5);
  EXPECT_TRUE(map.objects().At(b).is_locked);
  map.MutableObject(c).name = "yours";
  map.MutableObject(c).known_size = 0.7;
  map.ReplaceObject(c, b);
  EXPECT_EQ(map.objects().At(b).known_size, 0.5);
  EXPECT_EQ(map.objects().At(b).name, "mine");
  EXPECT_TRUE(map.objects().At(b).is_locked);
}

}  // namespace
}  // namespace hullslam

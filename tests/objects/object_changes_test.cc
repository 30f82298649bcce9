// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/object_changes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "map/keyframe_graph.h"
#include "objects/made_objects.h"
#include "objects/object_mapper.h"

namespace hullslam {
namespace {

// A camera goes around a table twice, in one session each. Things may be changed between the
// sessions.
class ObjectChanges : public testing::Test {
 protected:
  // One session over a third of the circle from `begin` (radians) on.
  void Visit(const std::vector<MadeObject>& objects, double begin = 0.0) {
    for (int i = 0; i < 10; ++i) {
      const Rigid3 cam_from_world = CameraOnCircle(begin + 0.2 * i, 1.5, 0.8);
      mapper_.Process(map_, AddObserverWithDepth(map_, sensor_, cam_from_world, objects));
    }
  }
  void EndFirstSession() {
    session_ = map_.NextFrame();
    former_ = map_.Snapshot();
  }
  std::vector<ChangedObject> Changes() const {
    return FindObjectChanges(former_, map_, session_, sensor_, options_);
  }
  // The change of the only object with this label.
  ObjectChange ChangeOf(const std::string& label) const {
    std::vector<ObjectChange> changes;
    for (const ChangedObject& changed : Changes()) {
      if (changed.label == label) {
        changes.push_back(changed.change);
      }
    }
    EXPECT_EQ(changes.size(), 1U) << label;
    return changes.at(0);
  }

  Sensor sensor_ = MakeObjectSensor();
  ObjectOptions options_;
  ObjectMapper mapper_{sensor_, options_};
  Map map_;
  Map former_;
  FrameId session_;
};

// A keyframe that sees these objects, and nothing but a wall at this depth (mm).
KeyframeId AddBeforeWall(Map& map, const Sensor& sensor, const Rigid3& cam_from_world,
                         const std::vector<MadeObject>& objects, int wall) {
  auto frame = std::make_shared<Frame>();
  frame->id = FrameId(map.keyframes().NextId().value);
  for (const MadeObject& object : objects) {
    frame->detections.push_back(Detect(object, sensor, cam_from_world));
  }
  frame->depth = DepthGrid(cv::Mat(480, 640, CV_16UC1, cv::Scalar(wall)), 1000.0);
  return map.AddKeyframe(std::move(frame), cam_from_world);
}

MadeObject Moved(MadeObject object, const Eigen::Vector3d& by) {
  object.ellipsoid.world_from_object.translation += by;
  return object;
}

TEST_F(ObjectChanges, AnObjectThatIsStillThereIsSeenAgain) {
  Visit(MakeTable());
  EndFirstSession();
  Visit(MakeTable());
  const std::vector<ChangedObject> changes = Changes();
  ASSERT_EQ(changes.size(), 3U);
  for (const ChangedObject& changed : changes) {
    EXPECT_EQ(changed.change, ObjectChange::kSeenAgain) << changed.label;
    EXPECT_EQ(changed.expected, 10);
    EXPECT_EQ(changed.found, 10);
    ASSERT_TRUE(changed.now && changed.former);
    EXPECT_EQ(changed.now->object, changed.former->object);
  }
}

// An object may be removed from the map although the keyframes show it.
TEST_F(ObjectChanges, WhatIsNoLongerInTheMapIsNotGoneIfItIsSeen) {
  Visit(MakeTable());
  EndFirstSession();
  Visit(MakeTable());
  const std::vector<ChangedObject> before = Changes();
  const auto cup = std::find_if(before.begin(), before.end(),
                                [](const auto& changed) { return changed.label == "cup"; });
  ASSERT_NE(cup, before.end());
  map_.EraseObject(cup->now->object);
  for (const ChangedObject& changed : Changes()) {
    EXPECT_EQ(changed.change, ObjectChange::kSeenAgain) << changed.label;
    EXPECT_EQ(changed.now.has_value(), changed.label != "cup");
  }
}

TEST_F(ObjectChanges, ANewObjectInPlaceOfARemovedOneIsTheSame) {
  Visit(MakeTable());
  EndFirstSession();
  ObjectId cup;
  for (const auto& [id, object] : former_.objects()) {
    cup = object.Label() == "cup" ? id : cup;
  }
  map_.EraseObject(cup);
  Visit(MakeTable());
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kSeenAgain);
  const std::vector<ChangedObject> changes = Changes();
  EXPECT_EQ(changes.size(), 3U);
  for (const ChangedObject& changed : changes) {
    ASSERT_TRUE(changed.now && changed.former);
    EXPECT_EQ(changed.now->object == changed.former->object, changed.label != "cup");
  }
}

TEST_F(ObjectChanges, WhatIsMissingIsGone) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> table = MakeTable();
  table.erase(table.begin());
  Visit(table);
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kGone);
  EXPECT_EQ(ChangeOf("book"), ObjectChange::kSeenAgain);
  EXPECT_EQ(ChangeOf("bottle"), ObjectChange::kSeenAgain);
}

TEST_F(ObjectChanges, ALockedObjectIsNotGone) {
  Visit(MakeTable());
  EndFirstSession();
  map_.MutableObject(ObjectId(0)).is_locked = true;
  std::vector<MadeObject> table = MakeTable();
  table.erase(table.begin());
  Visit(table);
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kNotSeen);
}

TEST_F(ObjectChanges, AnObjectThatWasNotThereIsNew) {
  std::vector<MadeObject> table = MakeTable();
  table.pop_back();
  Visit(table);
  EndFirstSession();
  Visit(MakeTable());
  EXPECT_EQ(ChangeOf("bottle"), ObjectChange::kNew);
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kSeenAgain);
}

TEST_F(ObjectChanges, AnObjectAtAnotherPlaceWasMoved) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> table = MakeTable();
  table[0] = Moved(table[0], {-0.25, -0.35, 0.0});
  Visit(table);
  const std::vector<ChangedObject> changes = Changes();
  EXPECT_EQ(changes.size(), 3U);
  const auto cup = std::find_if(changes.begin(), changes.end(),
                                [](const auto& changed) { return changed.label == "cup"; });
  ASSERT_NE(cup, changes.end());
  EXPECT_EQ(cup->change, ObjectChange::kMoved);
  EXPECT_LT((cup->former->ellipsoid.world_from_object.translation -
             MakeTable()[0].ellipsoid.world_from_object.translation)
                .norm(),
            0.02);
  EXPECT_LT((cup->now->ellipsoid.world_from_object.translation -
             table[0].ellipsoid.world_from_object.translation)
                .norm(),
            0.02);
  EXPECT_NE(cup->now->object, cup->former->object);
}

TEST_F(ObjectChanges, IfSeveralMayHaveBeenMovedItIsTheNearest) {
  std::vector<MadeObject> table = {MakeObject("cup", {0.3, 0.2, 0.0}, {0.05, 0.05, 0.06}),
                                   MakeObject("cup", {-0.3, -0.2, 0.0}, {0.05, 0.05, 0.06}),
                                   MakeTable()[2]};
  Visit(table);
  EndFirstSession();
  table[0] = Moved(table[0], {-0.2, 0.1, 0.0});
  table[1] = Moved(table[1], {0.2, 0.2, 0.0});
  Visit(table);
  int moved = 0;
  for (const ChangedObject& changed : Changes()) {
    if (changed.change == ObjectChange::kMoved) {
      ++moved;
      EXPECT_LT((changed.now->ellipsoid.world_from_object.translation -
                 changed.former->ellipsoid.world_from_object.translation)
                    .norm(),
                0.32);
    }
  }
  EXPECT_EQ(moved, 2);
}

TEST_F(ObjectChanges, AnObjectOfAnotherSizeOrTooFarAwayWasNotMoved) {
  Visit({MakeTable()[0], MakeTable()[1]});
  EndFirstSession();
  MadeObject large = Moved(MakeTable()[0], {-0.25, -0.35, 0.0});
  large.ellipsoid.half_axes *= 2.0;
  Visit({MakeTable()[1], large});
  options_.changes.max_size_ratio = 1.5;
  std::vector<ChangedObject> changes = Changes();
  ASSERT_EQ(changes.size(), 3U);
  EXPECT_EQ(changes[0].change, ObjectChange::kGone);
  EXPECT_EQ(changes[2].change, ObjectChange::kNew);
  options_.changes.max_size_ratio = 3.0;
  EXPECT_EQ(Changes().size(), 2U);
  options_.changes.max_move = 0.4;  // it is 0.43 m away
  EXPECT_EQ(Changes().size(), 3U);
}

TEST_F(ObjectChanges, AnObjectThatTheSessionDidNotLookAtIsNotSeen) {
  std::vector<MadeObject> table = MakeTable();
  Visit(table);
  EndFirstSession();
  // A camera that looks away from the table, at another one.
  const MadeObject chair = MakeObject("chair", {0.0, 5.0, 0.0}, {0.3, 0.3, 0.4});
  for (int i = 0; i < 6; ++i) {
    Rigid3 cam_from_world = CameraOnCircle(0.2 * i, 2.0, 0.8);
    cam_from_world.translation -=
        cam_from_world.rotation * chair.ellipsoid.world_from_object.translation;
    mapper_.Process(map_, AddObserverWithDepth(map_, sensor_, cam_from_world, {chair}));
  }
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kNotSeen);
  EXPECT_EQ(ChangeOf("chair"), ObjectChange::kFirstSeen);
}

TEST_F(ObjectChanges, ASessionWithoutMasksChangesNothing) {
  Visit(MakeTable());
  EndFirstSession();
  Visit({});
  EXPECT_TRUE(Changes().empty());
}

// The first session was too far away to expect a detection of the bottle, but its depth images may
// show the surfaces behind the place of the bottle.
class FarAway : public ObjectChanges {
 protected:
  ObjectChange ChangeOfBottle(int wall) {
    for (int i = 0; i < 10; ++i) {
      const Rigid3 cam_from_world = CameraOnCircle(0.2 * i, 3.0, 0.8);
      mapper_.Process(map_, AddBeforeWall(map_, sensor_, cam_from_world,
                                          {MakeTable()[0], MakeTable()[1]}, wall));
    }
    EndFirstSession();
    Visit(MakeTable());
    return ChangeOf("bottle");
  }
};

TEST_F(FarAway, AnObjectIsNewIfDepthShowedAnEmptyPlace) {
  EXPECT_EQ(ChangeOfBottle(6000), ObjectChange::kNew);
}

TEST_F(FarAway, WithoutDepthItIsFirstSeen) {
  EXPECT_EQ(ChangeOfBottle(0), ObjectChange::kFirstSeen);
}

// A bear hides a part of the table from all keyframes of the first session, so it is not known
// whether this part was empty. But if a cup is gone and a cup is found there, the cup was moved.
class BehindABear : public ObjectChanges {
 protected:
  static MadeObject Cup(double x, double y) {
    return MakeObject("cup", {x, y, 0.05}, {0.06, 0.05, 0.08});
  }
  void VisitFromOneSide(const std::vector<MadeObject>& objects) {
    for (int i = 0; i < 10; ++i) {
      const Rigid3 cam_from_world = CameraOnCircle(0.85 + 0.04 * i, 1.5, 0.3);
      mapper_.Process(map_, AddObserverWithDepth(map_, sensor_, cam_from_world, objects));
    }
  }
  // The changes after a session with a cup and a bear, and a second session with these cups.
  void ExpectMovedTo(const MadeObject& place, const std::vector<MadeObject>& cups) {
    VisitFromOneSide({Cup(0.4, -0.1), MakeObject("teddy bear", {0, -0.2, 0.1}, {0.2, 0.2, 0.2})});
    EndFirstSession();
    VisitFromOneSide(cups);
    EXPECT_EQ(ChangeOf("teddy bear"), ObjectChange::kGone);
    const std::vector<ChangedObject> changes = Changes();
    ASSERT_EQ(changes.size(), cups.size() + 1);
    ASSERT_EQ(changes[0].change, ObjectChange::kMoved);
    EXPECT_LT((changes[0].now->ellipsoid.world_from_object.translation -
               place.ellipsoid.world_from_object.translation)
                  .norm(),
              0.02);
  }
  const MadeObject hidden_ = Cup(-0.16, -0.51);
  const MadeObject seen_empty_ = Cup(-0.3, 0.5);  // farther away
};

TEST_F(BehindABear, AnObjectMayHaveBeenMovedToAPlaceThatWasHidden) {
  ExpectMovedTo(hidden_, {hidden_});
}

TEST_F(BehindABear, APlaceThatWasSeenEmptyExplainsMore) {
  ExpectMovedTo(seen_empty_, {hidden_, seen_empty_});
}

// Another object may stand at the place of an earlier one.
TEST_F(ObjectChanges, AnotherClassAtThePlaceIsNotTheObject) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> table = MakeTable();
  table[0].label = "orange";
  Visit(table);
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kGone);
}

TEST_F(ObjectChanges, AThingAtThePlaceOfAnotherBecomesAnObjectOfItsOwn) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> table = MakeTable();
  table[0].label = "orange";
  Visit(table);
  const ObjectId cup(0);
  ASSERT_EQ(former_.objects().At(cup).Label(), "cup");
  ASSERT_GT(map_.objects().At(cup).votes.count("orange"), 0U);  // it was taken for the cup
  EXPECT_TRUE(mapper_.SplitOff(map_, cup, former_.objects().At(cup), session_));
  EXPECT_EQ(map_.objects().At(cup).votes.count("orange"), 0U);
  EXPECT_EQ(ChangeOf("orange"), ObjectChange::kNew);
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kGone);
  EXPECT_EQ(Changes()[0].expected, 10);
  EXPECT_FALSE(mapper_.SplitOff(map_, cup, former_.objects().At(cup), session_));
}

// A larger object at the place of a smaller one hides this place from all sides.
TEST_F(ObjectChanges, AnObjectInsideAnotherOneIsGone) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> table = MakeTable();
  table[2] = MakeObject("box", table[2].ellipsoid.world_from_object.translation, {0.2, 0.2, 0.2});
  for (int i = 0; i < 10; ++i) {
    const Rigid3 cam_from_world = CameraOnCircle(0.2 * i, 1.5, 0.8);
    mapper_.Process(map_, AddBeforeWall(map_, sensor_, cam_from_world, table, 1000));
  }
  EXPECT_EQ(ChangeOf("bottle"), ObjectChange::kGone);
}

// A correction of the map moves the place where an object was, also if it is gone.
TEST_F(ObjectChanges, PlacesFollowCorrectionsOfTheMap) {
  Visit(MakeTable());
  EndFirstSession();
  const Rigid3 new_from_old(ExpSo3({0.0, 0.0, 0.3}), {1.0, 2.0, 3.0});
  for (uint32_t i = 0; i < 10; ++i) {
    const KeyframeId id(i);
    map_.SetPose(id, map_.keyframes().At(id).cam_from_world * Inverse(new_from_old));
  }
  map_.EraseObject(ObjectId(0));
  const Ellipsoid before = former_.objects().At(ObjectId(0)).ellipsoid;
  const MadeObject chair =
      MakeObject("chair", new_from_old * Eigen::Vector3d(0.0, 0.0, 0.0), {0.05, 0.05, 0.05});
  for (int i = 0; i < 4; ++i) {
    const Rigid3 pose = CameraOnCircle(0.2 * i, 1.5, 0.8) * Inverse(new_from_old);
    mapper_.Process(map_, AddObserverWithDepth(map_, sensor_, pose, {chair}));
  }
  const std::vector<ChangedObject> changes = Changes();
  ASSERT_FALSE(changes.empty());
  EXPECT_EQ(changes[0].change, ObjectChange::kGone);
  EXPECT_LT((changes[0].former->ellipsoid.world_from_object.translation -
             new_from_old * before.world_from_object.translation)
                .norm(),
            1e-9);
}

// The detector gives no mask, but the depth images show the cup.
TEST_F(ObjectChanges, WhatDepthShowsIsNotGone) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> seen = MakeTable();
  seen.erase(seen.begin());
  for (int i = 0; i < 10; ++i) {
    const Rigid3 camera = CameraOnCircle(0.2 * i, 1.5, 0.8);
    const KeyframeId id = AddObserverWithDepth(map_, sensor_, camera, seen);
    auto frame = std::make_shared<Frame>(*map_.keyframes().At(id).frame);
    frame->depth = DepthOf(MakeTable(), sensor_, camera, 4.0);
    map_.ReplaceFrame(id, frame);
    mapper_.Process(map_, id);
  }
  const ChangedObject cup = Changes().at(0);
  EXPECT_EQ(cup.change, ObjectChange::kNotSeen);
  EXPECT_EQ(cup.found, 0);
  EXPECT_EQ(cup.expected, 10);
}

// Six keyframes show something without a mask a little in front of the place of the cup. They tell
// nothing; the other four show that the cup is gone.
TEST_F(ObjectChanges, ALookAtWhatIsInFrontIsNoLook) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> seen = MakeTable();
  MadeObject sheet = seen[0];
  seen.erase(seen.begin());
  for (int i = 0; i < 10; ++i) {
    const Rigid3 camera = CameraOnCircle(0.2 * i, 1.5, 0.8);
    const KeyframeId id = AddObserverWithDepth(map_, sensor_, camera, seen);
    if (i < 6) {
      MadeObject nearer = sheet;
      const Eigen::Vector3d towards =
          Inverse(camera).translation - sheet.ellipsoid.world_from_object.translation;
      nearer.ellipsoid.world_from_object.translation +=
          0.5 * sheet.ellipsoid.half_axes.maxCoeff() * towards.normalized();
      std::vector<MadeObject> surfaces = seen;
      surfaces.push_back(nearer);
      auto frame = std::make_shared<Frame>(*map_.keyframes().At(id).frame);
      frame->depth = DepthOf(surfaces, sensor_, camera, 4.0);
      map_.ReplaceFrame(id, frame);
    }
    mapper_.Process(map_, id);
  }
  const ChangedObject cup = Changes().at(0);
  EXPECT_EQ(cup.change, ObjectChange::kGone);
  EXPECT_EQ(cup.expected, 4);
}

TEST_F(ObjectChanges, WhatIsKnownToHaveLeftIsGoneWhateverIsSeen) {
  Visit(MakeTable());
  EndFirstSession();
  Visit(MakeTable());
  const std::vector<ChangedObject> changes =
      FindObjectChanges(former_, map_, session_, sensor_, options_, {ObjectId(0)});
  ASSERT_EQ(changes.at(0).former->object, ObjectId(0));
  EXPECT_EQ(changes.at(0).change, ObjectChange::kGone);
  EXPECT_EQ(changes.at(1).change, ObjectChange::kSeenAgain);
}

// Too few samples of the depth grid are on the marble for its surface to be measured.
TEST_F(ObjectChanges, ASmallObjectIsGoneWithoutAMeasuredSurface) {
  std::vector<MadeObject> table = MakeTable();
  table.push_back(MakeObject("marble", {0.1, -0.1, 0.0}, {0.012, 0.012, 0.012}));
  Visit(table);
  EndFirstSession();
  Visit(MakeTable());
  EXPECT_EQ(ChangeOf("marble"), ObjectChange::kGone);
}

// Four looks are enough for a detector that always finds the cup, but not for one that often misses
// it.
TEST_F(ObjectChanges, TheFirstSessionTellsHowManyLooksAreEnough) {
  std::vector<MadeObject> without = MakeTable();
  without.erase(without.begin());
  const auto look = [&](double angle, bool has_cup) {
    const Rigid3 camera = CameraOnCircle(angle, 1.5, 0.8);
    mapper_.Process(map_,
                    AddObserverWithDepth(map_, sensor_, camera, has_cup ? MakeTable() : without));
  };
  for (const int period : {1, 3}) {
    map_ = Map();
    for (int i = 0; i < 12; ++i) {
      look(0.1 * i, i % period == 0);
    }
    EndFirstSession();
    for (int i = 0; i < 4; ++i) {
      look(0.1 * i, false);
    }
    EXPECT_EQ(ChangeOf("cup"), period == 1 ? ObjectChange::kGone : ObjectChange::kNotSeen);
  }
}

// The detector calls the book a keyboard in the second session. In the first one it has confused
// the classes of another object, so this proves nothing.
TEST_F(ObjectChanges, ADoubledObjectOfAClassThatIsOftenConfusedIsNoReplacement) {
  Visit(MakeTable());
  EndFirstSession();
  former_.MutableObject(ObjectId(2)).votes = {{"bottle", 7.0}, {"cup", 3.0}};
  std::vector<MadeObject> table = MakeTable();
  table[1].label = "keyboard";
  for (int i = 0; i < 10; ++i) {
    AddObserverWithDepth(map_, sensor_, CameraOnCircle(0.2 * i, 1.5, 0.8), table);
  }
  const ChangedObject book = Changes().at(1);
  EXPECT_EQ(book.label, "book");
  EXPECT_EQ(book.change, ObjectChange::kSeenAgain);
  EXPECT_EQ(book.found, 10);
}

TEST(ObjectChangeNames, AreDifferent) {
  for (const ObjectChange a : kObjectChanges) {
    for (const ObjectChange b : kObjectChanges) {
      EXPECT_EQ(ToString(a) == ToString(b), a == b);
    }
  }
}

// A correction that doubles all lengths since the first session also doubles the object.
TEST_F(ObjectChanges, SizesFollowCorrectionsOfTheScale) {
  Visit(MakeTable());
  EndFirstSession();
  for (uint32_t i = 0; i < 10; ++i) {
    const KeyframeId id(i);
    Rigid3 pose = map_.keyframes().At(id).cam_from_world;
    pose.translation *= 2.0;
    map_.SetPose(id, pose);
    map_.MutableKeyframe(id).scale = 2.0;
  }
  AddObserverWithDepth(map_, sensor_, CameraOnCircle(0.0, 1.5, 0.8), MakeTable());
  const Ellipsoid before = former_.objects().At(ObjectId(0)).ellipsoid;
  const Ellipsoid after = Changes().at(0).former->ellipsoid;
  EXPECT_LT(
      (after.world_from_object.translation - 2.0 * before.world_from_object.translation).norm(),
      1e-9);
  EXPECT_LT((after.half_axes - 2.0 * before.half_axes).norm(), 1e-9);
}

// The shortest half axis of flat things is not known precisely.
TEST_F(ObjectChanges, TheTwoLongestHalfAxesTellWhetherAMovedObjectIsAnother) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> table = MakeTable();
  table[0] = Moved(table[0], {-0.25, -0.35, 0.0});
  Visit(table);
  const auto is_moved = [&](const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
    former_.MutableObject(ObjectId(0)).ellipsoid.half_axes = before;
    map_.MutableObject(ObjectId(3)).ellipsoid.half_axes = after;
    return Changes().at(0).change == ObjectChange::kMoved;
  };
  ASSERT_EQ(former_.objects().At(ObjectId(0)).Label(), "cup");
  ASSERT_EQ(map_.objects().At(ObjectId(3)).Label(), "cup");
  EXPECT_TRUE(is_moved({0.02, 0.06, 0.08}, {0.08, 0.06, 0.07}));  // the shortest is 3 times as long
  EXPECT_TRUE(is_moved({0.07, 0.08, 0.06}, {0.08, 0.02, 0.06}));
  EXPECT_FALSE(is_moved({0.02, 0.02, 0.08}, {0.02, 0.08, 0.06}));  // the middle one
  EXPECT_FALSE(is_moved({0.02, 0.06, 0.08}, {0.02, 0.08, 0.02}));
  EXPECT_FALSE(is_moved({0.02, 0.03, 0.09}, {0.02, 0.03, 0.03}));  // the longest one
  EXPECT_FALSE(is_moved({0.02, 0.03, 0.03}, {0.02, 0.03, 0.09}));
}

TEST_F(ObjectChanges, AClassWithAFifthOfTheVotesMayBeTheObject) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> table = MakeTable();
  table[0].label = "orange";
  Visit(table);
  former_.MutableObject(ObjectId(1)).votes = {{"book", 100.0}};  // classes are seldom confused
  former_.MutableObject(ObjectId(0)).votes = {{"cup", 0.81}, {"orange", 0.19}};
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kGone);
  former_.MutableObject(ObjectId(0)).votes = {{"cup", 0.79}, {"orange", 0.21}};
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kSeenAgain);
}

// One of ten keyframes shows the object, the others show that it is missing.
TEST_F(ObjectChanges, EnoughKeyframesMustShowThatItIsMissing) {
  Visit(MakeTable());
  EndFirstSession();
  for (int i = 0; i < 10; ++i) {
    std::vector<MadeObject> table = MakeTable();
    if (i > 0) {
      table.erase(table.begin());
    }
    mapper_.Process(map_,
                    AddObserverWithDepth(map_, sensor_, CameraOnCircle(0.2 * i, 1.5, 0.8), table));
  }
  options_.changes.min_keyframes = 10;
  options_.changes.max_found_ratio = 0.11;
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kGone);
  options_.changes.max_found_ratio = 0.1;  // not fewer than that
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kSeenAgain);
  options_.changes.max_found_ratio = 0.11;
  options_.changes.min_keyframes = 11;  // too few for a judgement, but it was seen
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kSeenAgain);
}

TEST_F(ObjectChanges, TooFewKeyframesThatShowItMissingTellNothing) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> table = MakeTable();
  table.erase(table.begin());
  Visit(table);
  options_.changes.min_keyframes = 11;
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kNotSeen);
}

TEST_F(ObjectChanges, WhatWasSeenBeforeButNotMappedIsFirstSeen) {
  Visit(MakeTable());
  EndFirstSession();
  former_.MutableObject(ObjectId(2)).state = ObjectState::kCandidate;
  Visit(MakeTable());
  const std::vector<ChangedObject> changes = Changes();
  ASSERT_EQ(changes.size(), 3U);
  EXPECT_EQ(changes[2].label, "bottle");
  EXPECT_EQ(changes[2].change, ObjectChange::kFirstSeen);
  EXPECT_EQ(changes[2].found, 10);
}

TEST_F(ObjectChanges, OnlyAnObjectOfTheMapThatIsNotGoneHasALocationNow) {
  Visit(MakeTable());
  EndFirstSession();
  AddObserverWithDepth(map_, sensor_, CameraOnCircle(0.0, 1.5, 0.8),
                       {MakeObject("chair", {0.0, 0.0, 0.1}, {0.1, 0.1, 0.1})});
  ASSERT_EQ(Changes().at(0).change, ObjectChange::kNotSeen);
  EXPECT_TRUE(Changes().at(0).now);
  map_.MutableObject(ObjectId(0)).has_shape = false;
  EXPECT_FALSE(Changes().at(0).now);
  EXPECT_EQ(Changes().at(0).change, ObjectChange::kNotSeen);
  std::vector<MadeObject> table = MakeTable();
  table.pop_back();
  Visit(table);
  EXPECT_EQ(Changes().at(2).change, ObjectChange::kGone);
  EXPECT_FALSE(Changes().at(2).now);
}

// A cup that was removed from the map, and a new object in its place, which the second session has
// made.
class RemovedCup : public ObjectChanges {
 protected:
  RemovedCup() {
    Visit({MakeTable()[0], MakeObject("cup", {-0.3, -0.2, 0.0}, {0.05, 0.05, 0.06})});
    EndFirstSession();
    map_.EraseObject(ObjectId(0));
    Visit({MakeTable()[0], MakeObject("cup", {-0.3, -0.2, 0.0}, {0.05, 0.05, 0.06})});
  }
  const ObjectId other_ = ObjectId(1);  // the other cup of the first session
  const ObjectId new_ = ObjectId(2);
};

TEST_F(RemovedCup, TheNewObjectIsTheCup) {
  const std::vector<ChangedObject> changes = Changes();
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes[0].change, ObjectChange::kSeenAgain);
  EXPECT_EQ(changes[0].now->object, new_);
}

// The longest half axis of the cup is 8 cm, the shortest one is 5 cm.
TEST_F(RemovedCup, TheNewObjectMustBeNear) {
  map_.MutableObject(new_).ellipsoid.world_from_object.translation.x() += 0.07;
  EXPECT_TRUE(Changes().at(0).now);
  map_.MutableObject(new_).ellipsoid.world_from_object.translation.x() += 0.03;
  EXPECT_FALSE(Changes().at(0).now);
}

TEST_F(RemovedCup, TheNewObjectMustBeMapped) {
  map_.MutableObject(new_).state = ObjectState::kCandidate;
  EXPECT_EQ(Changes().at(0).change, ObjectChange::kSeenAgain);
  EXPECT_FALSE(Changes().at(0).now);
}

TEST_F(RemovedCup, TheNewObjectMustBeOfItsClass) {
  map_.MutableObject(new_).votes = {{"orange", 1.0}};
  EXPECT_FALSE(Changes().at(0).now);
}

TEST_F(RemovedCup, AnObjectOfTheFirstSessionIsNotTheCup) {
  const Ellipsoid of_new = map_.objects().At(new_).ellipsoid;
  map_.MutableObject(other_).ellipsoid = of_new;
  map_.MutableObject(new_).state = ObjectState::kCandidate;
  EXPECT_FALSE(Changes().at(0).now);
}

TEST_F(RemovedCup, TheNewObjectIsOneCupOnly) {
  const Ellipsoid of_cup = former_.objects().At(ObjectId(0)).ellipsoid;
  former_.MutableObject(other_).ellipsoid = of_cup;
  map_.EraseObject(other_);
  const std::vector<ChangedObject> changes = Changes();
  EXPECT_TRUE(changes.at(0).now);
  EXPECT_FALSE(changes.at(1).now);
}

TEST_F(ObjectChanges, AnObjectThatWasReplacedIsTheOtherOne) {
  const std::vector<MadeObject> table = {MakeObject("cup", {0.3, 0.2, 0.0}, {0.05, 0.05, 0.06}),
                                         MakeObject("cup", {-0.3, -0.2, 0.0}, {0.05, 0.05, 0.06})};
  Visit(table);
  EndFirstSession();
  Visit(table);
  map_.ReplaceObject(ObjectId(0), ObjectId(1));
  const std::vector<ChangedObject> changes = Changes();
  ASSERT_EQ(changes.size(), 2U);
  ASSERT_TRUE(changes[0].now);
  EXPECT_EQ(changes[0].former->object, ObjectId(0));
  EXPECT_EQ(changes[0].now->object, ObjectId(1));
}

TEST_F(ObjectChanges, AKeyframeOfTheObjectMayHaveBeenCulled) {
  Visit(MakeTable());
  SetParent(map_, KeyframeId(4), KeyframeId(3));
  EndFirstSession();
  std::vector<MadeObject> table = MakeTable();
  table.erase(table.begin());
  Visit(table);
  map_.CullKeyframe(KeyframeId(4));
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kGone);
}

// The keyframes of a second session whose detections belong to no object yet.
class UnknownDetections : public ObjectChanges {
 protected:
  UnknownDetections() {
    Visit(MakeTable());
    EndFirstSession();
  }
  // `shown` gives what a camera sees in place of the cup.
  template <typename Shown>
  ChangedObject CupAfter(const Shown& shown, bool has_depth = true) {
    for (int i = 0; i < 10; ++i) {
      const Rigid3 camera = CameraOnCircle(0.2 * i, 1.5, 0.8);
      const KeyframeId id = AddObserverWithDepth(map_, sensor_, camera, {shown(camera)});
      if (!has_depth) {
        auto frame = std::make_shared<Frame>(*map_.keyframes().At(id).frame);
        frame->detections[0].points.clear();
        map_.ReplaceFrame(id, frame);
      }
    }
    return Changes().at(0);
  }
  // A cup that looks the same, at this share of the distance.
  static MadeObject Nearer(const Rigid3& camera, double share) {
    MadeObject cup = MakeTable()[0];
    const Eigen::Vector3d center = Inverse(camera).translation;
    Eigen::Vector3d& position = cup.ellipsoid.world_from_object.translation;
    position = center + share * (position - center);
    cup.ellipsoid.half_axes *= share;
    return cup;
  }
};

// The centroid of the visible surface is about 4 cm in front of the centre, the longest half axis
// is 8 cm.
TEST_F(UnknownDetections, TheObjectIsAtItsOwnDistance) {
  EXPECT_EQ(CupAfter([](const Rigid3& camera) { return Nearer(camera, 0.985); }).found, 10);
}
TEST_F(UnknownDetections, SomethingNearerThatLooksTheSameIsAnotherOne) {
  EXPECT_EQ(CupAfter([](const Rigid3& camera) { return Nearer(camera, 0.96); }).found, 0);
}
TEST_F(UnknownDetections, WithoutDepthWhatLooksTheSameIsTheObject) {
  EXPECT_EQ(CupAfter([](const Rigid3& camera) { return Nearer(camera, 0.5); }, false).found, 10);
}

// About half of the cup's width beside it.
TEST_F(UnknownDetections, TheOutlinesMustOverlap) {
  const auto beside = [](const Rigid3&) { return Moved(MakeTable()[0], {0.0, 0.0, 0.06}); };
  EXPECT_EQ(CupAfter(beside, false).found, 10);
  options_.changes.min_overlap = 0.6;
  EXPECT_EQ(Changes().at(0).found, 0);
}

// Neither has an object: the cup because it was erased, the detection because it belongs to none.
TEST_F(UnknownDetections, AnErasedObjectIsNotEveryUnknownDetection) {
  map_.EraseObject(ObjectId(0));
  const ChangedObject cup = CupAfter([](const Rigid3&) {
    return Moved(MakeTable()[0], {-0.25, -0.35, 0.0});
  });
  EXPECT_EQ(cup.found, 0);
  EXPECT_EQ(cup.change, ObjectChange::kGone);
}

// Another cup of the first session now stands where the cup was.
TEST_F(ObjectChanges, AnotherKnownObjectAtThePlaceIsNotTheObject) {
  const std::vector<MadeObject> cups = {MakeObject("cup", {0.3, 0.2, 0.0}, {0.05, 0.05, 0.06}),
                                        MakeObject("cup", {-0.3, -0.2, 0.0}, {0.05, 0.05, 0.06})};
  Visit(cups);
  EndFirstSession();
  for (int i = 0; i < 10; ++i) {
    const KeyframeId id =
        AddObserverWithDepth(map_, sensor_, CameraOnCircle(0.2 * i, 1.5, 0.8), {cups.front()});
    map_.AddObservation(ObjectId(1), id, 0);
  }
  const std::vector<ChangedObject> changes = Changes();
  EXPECT_EQ(changes.at(0).change, ObjectChange::kNotSeen);  // nothing behind it is seen
  EXPECT_EQ(changes.at(0).found, 0);
  EXPECT_EQ(changes.at(1).change, ObjectChange::kSeenAgain);
}

// A wall of depth 1 m hides everything, so only a thing in place of the object can tell that the
// object is gone.
class BehindAWall : public ObjectChanges {
 protected:
  void VisitBeforeWall(const std::vector<MadeObject>& table) {
    for (int i = 0; i < 10; ++i) {
      mapper_.Process(map_,
                      AddBeforeWall(map_, sensor_, CameraOnCircle(0.2 * i, 1.5, 0.8), table, 1000));
    }
  }
  // With a box around the place of the bottle. Returns the box.
  ObjectId ReplaceBottle() {
    Visit(MakeTable());
    EndFirstSession();
    std::vector<MadeObject> table = MakeTable();
    table[2] = MakeObject("box", table[2].ellipsoid.world_from_object.translation, {0.2, 0.2, 0.2});
    VisitBeforeWall(table);
    ObjectId found;
    for (const auto& [id, object] : map_.objects()) {
      found = object.Label() == "box" ? id : found;
    }
    return found;
  }
};

TEST_F(BehindAWall, WhatNobodySeesIsNotSeen) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> table = MakeTable();
  table.pop_back();
  VisitBeforeWall(table);
  EXPECT_EQ(ChangeOf("bottle"), ObjectChange::kNotSeen);
}

TEST_F(BehindAWall, AnotherClassInPlaceOfTheObjectTellsThatItIsGone) {
  Visit(MakeTable());
  EndFirstSession();
  std::vector<MadeObject> table = MakeTable();
  table[0].label = "orange";
  VisitBeforeWall(table);
  ASSERT_GT(map_.objects().At(ObjectId(0)).votes.count("orange"), 0U);
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kGone);
}

TEST_F(BehindAWall, OnlyAMappedObjectTakesAPlace) {
  const ObjectId box = ReplaceBottle();
  ASSERT_TRUE(box.IsValid());
  EXPECT_EQ(ChangeOf("bottle"), ObjectChange::kGone);
  map_.MutableObject(box).state = ObjectState::kCandidate;
  EXPECT_EQ(ChangeOf("bottle"), ObjectChange::kNotSeen);
}

TEST_F(BehindAWall, AnObjectThatWasThereBeforeTakesNoPlace) {
  const ObjectId box = ReplaceBottle();
  ASSERT_TRUE(box.IsValid());
  while (former_.objects().NextId() <= box) {
    former_.AddObject();
  }
  former_.MutableObject(box) = map_.objects().At(box);
  former_.MutableObject(box).reference = KeyframeId(0);
  EXPECT_EQ(ChangeOf("bottle"), ObjectChange::kNotSeen);
}

TEST_F(ObjectChanges, OfTwoPlacesTheOneWithTheLikeSizeIsMoreLikely) {
  const MadeObject cup = MakeTable()[0];
  Visit({cup, MakeTable()[1]});
  EndFirstSession();
  MadeObject large = Moved(cup, {-0.25, -0.35, 0.0});
  large.ellipsoid.half_axes *= 1.6;
  const MadeObject like = Moved(cup, {-0.5, -0.3, 0.0});  // 13 cm farther away
  Visit({MakeTable()[1], large, like});
  const ChangedObject moved = Changes().at(0);
  ASSERT_EQ(moved.change, ObjectChange::kMoved);
  EXPECT_LT((moved.now->ellipsoid.world_from_object.translation -
             like.ellipsoid.world_from_object.translation)
                .norm(),
            0.05);
}

// All ten keyframes of the first session looked at the hidden place.
TEST_F(BehindABear, EnoughKeyframesMustHaveLookedAtTheHiddenPlace) {
  options_.changes.max_found_ratio = 0.01;
  ExpectMovedTo(hidden_, {hidden_});
  options_.changes.min_keyframes = 10;
  EXPECT_EQ(Changes().at(0).change, ObjectChange::kMoved);
  for (uint32_t i = 0; i < 2; ++i) {  // two of them show nothing that may count
    auto frame = std::make_shared<Frame>(*map_.keyframes().At(KeyframeId(i)).frame);
    frame->detections.clear();
    map_.MutableKeyframe(KeyframeId(i)).objects.clear();
    map_.ReplaceFrame(KeyframeId(i), frame);
  }
  EXPECT_EQ(Changes().at(0).change, ObjectChange::kGone);
}

// One keyframe of the first session showed the hidden cup, so it was there already.
TEST_F(BehindABear, AnObjectThatWasSeenBeforeWasNotMovedThere) {
  const MadeObject bear = MakeObject("teddy bear", {0, -0.2, 0.1}, {0.2, 0.2, 0.2});
  VisitFromOneSide({Cup(0.4, -0.1), bear});
  mapper_.Process(map_, AddObserverWithDepth(map_, sensor_, CameraOnCircle(0.9, 1.5, 0.3),
                                             {Cup(0.4, -0.1), bear, hidden_}));
  EndFirstSession();
  VisitFromOneSide({hidden_});
  const std::vector<ChangedObject> changes = Changes();
  ASSERT_EQ(changes.size(), 3U);
  EXPECT_EQ(changes[0].change, ObjectChange::kGone);
  EXPECT_EQ(changes[2].change, ObjectChange::kFirstSeen);
  EXPECT_EQ(changes[2].found, 1);
}

}  // namespace
}  // namespace hullslam

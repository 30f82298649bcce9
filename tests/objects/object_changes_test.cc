// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/object_changes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

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
      mapper_.Process(map_, AddObserver(map_, sensor_, cam_from_world, objects));
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

// An object may be removed from the map although some keyframes show it.
TEST_F(ObjectChanges, WhatIsNoLongerInTheMapIsNotSeenAgain) {
  Visit(MakeTable());
  EndFirstSession();
  Visit(MakeTable());
  const std::vector<ChangedObject> before = Changes();
  const auto cup = std::find_if(before.begin(), before.end(),
                                [](const auto& changed) { return changed.label == "cup"; });
  ASSERT_NE(cup, before.end());
  map_.EraseObject(cup->now->object);
  EXPECT_EQ(ChangeOf("cup"), ObjectChange::kGone);
  for (const ChangedObject& changed : Changes()) {
    EXPECT_EQ(changed.now.has_value(), changed.change == ObjectChange::kSeenAgain);
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
    mapper_.Process(map_, AddObserver(map_, sensor_, cam_from_world, {chair}));
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
      mapper_.Process(map_, AddObserver(map_, sensor_, cam_from_world, objects));
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
    mapper_.Process(map_, AddObserver(map_, sensor_, pose, {chair}));
  }
  const std::vector<ChangedObject> changes = Changes();
  ASSERT_FALSE(changes.empty());
  EXPECT_EQ(changes[0].change, ObjectChange::kGone);
  EXPECT_LT((changes[0].former->ellipsoid.world_from_object.translation -
             new_from_old * before.world_from_object.translation)
                .norm(),
            1e-9);
}

TEST(ObjectChangeNames, AreDifferent) {
  for (const ObjectChange a : kObjectChanges) {
    for (const ObjectChange b : kObjectChanges) {
      EXPECT_EQ(ToString(a) == ToString(b), a == b);
    }
  }
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/map.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hullslam/util/check.h"
#include "map/keyframe_graph.h"
#include "map/made_map.h"
#include "map/random_edits.h"
#include "map_files/invariants.h"
#include "support/made_vocabulary.h"
#include "support/pose_distance.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

TEST(Map, KeyframeHasOneEntryPerKeypoint) {
  Map map;
  const KeyframeId id = AddKeyframe(map, 7);
  EXPECT_EQ(id, KeyframeId(0));
  EXPECT_EQ(map.keyframes().At(id).landmarks, std::vector<LandmarkId>(7));
  EXPECT_THROW(map.AddKeyframe(nullptr, {}), CheckError);
}

TEST(Map, ObservationIsKnownAtBothEnds) {
  Map map;
  const KeyframeId a = AddKeyframe(map, 5);
  const KeyframeId b = AddKeyframe(map, 5, 2);
  const LandmarkId landmark = map.AddLandmark({1.0, 2.0, 3.0}, b);
  EXPECT_TRUE(map.AddObservation(landmark, b, 1));  // has a depth
  EXPECT_TRUE(map.AddObservation(landmark, a, 4));
  EXPECT_EQ(map.keyframes().At(b).landmarks[1], landmark);
  EXPECT_EQ(map.keyframes().At(a).landmarks[4], landmark);
  const Landmark& seen = map.landmarks().At(landmark);
  ASSERT_EQ(seen.observations.size(), 2u);
  EXPECT_EQ(seen.observations[0].keyframe, a);  // in order of the ids
  EXPECT_EQ(seen.observations[0].keypoint, 4u);
  EXPECT_EQ(seen.observations[1].keyframe, b);
  EXPECT_EQ(seen.observation_weight, 3);
  EXPECT_EQ(seen.reference, b);
  EXPECT_EQ(seen.created_by, b);
}

TEST(Map, AKeyframeObservesALandmarkAtOneKeypointOnly) {
  Map map;
  const KeyframeId keyframe = AddKeyframe(map, 5);
  const LandmarkId a = map.AddLandmark({}, keyframe);
  const LandmarkId b = map.AddLandmark({}, keyframe);
  ASSERT_TRUE(map.AddObservation(a, keyframe, 0));
  const std::string before = Dump(map);
  EXPECT_FALSE(map.AddObservation(a, keyframe, 0));
  EXPECT_FALSE(map.AddObservation(a, keyframe, 1));
  EXPECT_FALSE(map.AddObservation(b, keyframe, 0));
  EXPECT_EQ(Dump(map), before);
}

TEST(Map, RefusesIdsThatDoNotExist) {
  Map map;
  const KeyframeId keyframe = AddKeyframe(map, 5);
  const LandmarkId landmark = map.AddLandmark({}, keyframe);
  EXPECT_THROW(map.AddObservation(landmark, keyframe, 5), CheckError);
  EXPECT_THROW(map.AddObservation(landmark, KeyframeId(9), 0), CheckError);
  EXPECT_THROW(map.AddObservation(LandmarkId(9), keyframe, 0), CheckError);
  EXPECT_THROW(map.RemoveObservation(landmark, keyframe), CheckError);
  EXPECT_THROW(map.EraseLandmark(LandmarkId(9)), CheckError);
  EXPECT_THROW(map.ReplaceLandmark(landmark, landmark), CheckError);
  EXPECT_THROW(map.CamFromWorld(KeyframeId(9)), CheckError);
}

TEST(Map, RemovingAnObservationFreesTheKeypointAndMovesTheReference) {
  Map map;
  const std::vector<KeyframeId> ids = {AddKeyframe(map, 5), AddKeyframe(map, 5),
                                       AddKeyframe(map, 5), AddKeyframe(map, 5)};
  const LandmarkId landmark = Share(map, ids).front();
  map.RemoveObservation(landmark, ids[0]);
  EXPECT_FALSE(map.keyframes().At(ids[0]).landmarks[0].IsValid());
  EXPECT_EQ(map.landmarks().At(landmark).observation_weight, 3);
  EXPECT_EQ(map.landmarks().At(landmark).reference, ids[1]);
  EXPECT_TRUE(map.AddObservation(landmark, ids[0], 3));
  EXPECT_EQ(map.landmarks().At(landmark).reference, ids[1]);
}

TEST(Map, ALandmarkIsRemovedWhenItsObservationWeightFallsToTwo) {
  Map map;
  const std::vector<KeyframeId> ids = {AddKeyframe(map, 5, 5), AddKeyframe(map, 5),
                                       AddKeyframe(map, 5)};
  // One observation with depth and two without: weight 4, then 3, then 2.
  const LandmarkId landmark = Share(map, ids).front();
  map.RemoveObservation(landmark, ids[1]);
  EXPECT_TRUE(map.landmarks().Contains(landmark));
  map.RemoveObservation(landmark, ids[2]);
  EXPECT_FALSE(map.landmarks().Contains(landmark));
  EXPECT_FALSE(map.keyframes().At(ids[0]).landmarks[0].IsValid());
  EXPECT_FALSE(map.Resolve(landmark).IsValid());
}

TEST(Map, ReplacingMovesObservationsAndSightings) {
  Map map;
  const KeyframeId a = AddKeyframe(map, 5);
  const KeyframeId b = AddKeyframe(map, 5);
  const KeyframeId c = AddKeyframe(map, 5);
  const LandmarkId old = Share(map, {a, b}).front();   // keypoints 0 and 0
  const LandmarkId kept = Share(map, {b, c}).front();  // keypoints 1 and 0
  map.CountSightings(old, 10, 5);
  map.ReplaceLandmark(old, kept);
  EXPECT_FALSE(map.landmarks().Contains(old));
  EXPECT_EQ(map.Resolve(old), kept);
  const Landmark& landmark = map.landmarks().At(kept);
  ASSERT_EQ(landmark.observations.size(), 3u);
  EXPECT_EQ(landmark.observations[1].keypoint,
            1u);  // b observed both: its observation of `kept` stays
  EXPECT_EQ(landmark.observation_weight, 3);
  EXPECT_EQ(map.keyframes().At(a).landmarks[0], kept);
  EXPECT_FALSE(map.keyframes().At(b).landmarks[0].IsValid());
  EXPECT_EQ(landmark.visible, 12);
  EXPECT_EQ(landmark.found, 7);
}

TEST(Map, ResolveFollowsAChainOfReplacements) {
  Map map;
  const KeyframeId keyframe = AddKeyframe(map, 5);
  std::vector<LandmarkId> ids;
  for (int i = 0; i < 4; ++i) {
    ids.push_back(map.AddLandmark({}, keyframe));
  }
  map.ReplaceLandmark(ids[0], ids[2]);
  map.ReplaceLandmark(ids[2], ids[1]);
  map.ReplaceLandmark(ids[1], ids[3]);
  for (const LandmarkId id : ids) {
    EXPECT_EQ(map.Resolve(id), ids[3]);
  }
  map.EraseLandmark(ids[3]);
  for (const LandmarkId id : ids) {
    EXPECT_FALSE(map.Resolve(id).IsValid());
  }
  EXPECT_FALSE(map.Resolve(LandmarkId()).IsValid());
  EXPECT_FALSE(map.Resolve(LandmarkId(99)).IsValid());
}

TEST(Map, AnErasedLandmarkStaysAbsentWhenItsSlotIsUsedAgain) {
  Map map;
  const KeyframeId keyframe = AddKeyframe(map, 5);
  const LandmarkId old = map.AddLandmark({1.0, 0.0, 0.0}, keyframe);
  Map snapshot = map.Snapshot();
  map.EraseLandmark(old);
  const LandmarkId later = map.AddLandmark({2.0, 0.0, 0.0}, keyframe);
  EXPECT_EQ(later.slot(), old.slot());
  EXPECT_FALSE(map.landmarks().Contains(old));
  EXPECT_FALSE(map.Resolve(old).IsValid());
  EXPECT_FALSE(snapshot.landmarks().Contains(later));
  EXPECT_EQ(snapshot.landmarks().At(old).position.x(), 1.0);
}

// A slot is used again while messages still have the ids of earlier landmarks in it.
TEST(Map, ReplacedIdsOfOneSlotDoNotMixUp) {
  Map map;
  const KeyframeId keyframe = AddKeyframe(map, 5);
  const LandmarkId a = map.AddLandmark({}, keyframe);
  const LandmarkId b = map.AddLandmark({}, keyframe);
  const LandmarkId first = map.AddLandmark({}, keyframe);
  map.ReplaceLandmark(first, a);
  const LandmarkId second = map.AddLandmark({}, keyframe);
  ASSERT_EQ(second.slot(), first.slot());
  map.ReplaceLandmark(second, b);
  EXPECT_EQ(map.Resolve(first), a);
  EXPECT_EQ(map.Resolve(second), b);
}

TEST(Map, ForgetsReplacementsThatAreOlderThanASnapshot) {
  Map map;
  const KeyframeId keyframe = AddKeyframe(map, 5);
  std::vector<LandmarkId> ids;
  for (int i = 0; i < 4; ++i) {
    ids.push_back(map.AddLandmark({}, keyframe));
  }
  EXPECT_EQ(map.revision(), 0u);
  const Map first = map.Snapshot();
  EXPECT_EQ(first.revision(), 1u);
  EXPECT_EQ(map.revision(), 1u);
  map.ReplaceLandmark(ids[0], ids[3]);
  const Map second = map.Snapshot();
  map.ReplaceLandmark(ids[1], ids[3]);
  const ObjectId object = map.AddObject();
  const ObjectId other = map.AddObject();
  map.ReplaceObject(object, other);
  map.ForgetReplaced(first.revision());
  EXPECT_EQ(map.replaced_count(), 3u) << "the first snapshot has all of the replaced landmarks";
  map.ForgetReplaced(second.revision());
  EXPECT_EQ(map.replaced_count(), 2u);
  EXPECT_FALSE(map.Resolve(ids[0]).IsValid());
  EXPECT_EQ(map.Resolve(ids[1]), ids[3]);
  EXPECT_EQ(map.Resolve(object), other);
  EXPECT_EQ(second.Resolve(ids[0]), ids[3]) << "the snapshot keeps what it knows";
}

// The changes of a session are found at its end, long after an object was fused into another one.
TEST(Map, RemembersWhatReplacedObjectsOfEarlierSessions) {
  Map map;
  AddKeyframe(map, 5);
  const ObjectId earlier = map.AddObject();
  EXPECT_FALSE(map.IsOfEarlierSession(earlier));
  map.BeginSession({"second", map.NextFrame()});
  const ObjectId first = map.AddObject();
  const ObjectId second = map.AddObject();
  EXPECT_TRUE(map.IsOfEarlierSession(earlier));
  EXPECT_FALSE(map.IsOfEarlierSession(first));
  map.ReplaceObject(earlier, first);
  map.ReplaceObject(first, second);
  map.Snapshot();
  map.ForgetReplaced(map.revision());
  EXPECT_EQ(map.Resolve(earlier), second);
  EXPECT_FALSE(map.Resolve(first).IsValid());
  EXPECT_TRUE(map.Snapshot().IsOfEarlierSession(earlier));
}

// A root and three keyframes, each the child of the one before, at random poses.
class CulledKeyframes : public ::testing::Test {
 protected:
  CulledKeyframes() {
    for (int i = 0; i < 4; ++i) {
      AddKeyframe(map_, 30, 0, random_.Pose(1.0, 2.0));
      if (i > 0) {
        SetParent(map_, Id(i), Id(i - 1));
      }
    }
  }
  static KeyframeId Id(int i) { return KeyframeId(static_cast<uint32_t>(i)); }

  Map map_;
  RandomGeometry random_{1};
};

TEST_F(CulledKeyframes, LeaveTheMapWithTheirObservations) {
  const LandmarkId strong = Share(map_, {Id(0), Id(1), Id(2), Id(3)}).front();
  const LandmarkId weak = Share(map_, {Id(1), Id(2)}).front();
  map_.CullKeyframe(Id(1));
  EXPECT_FALSE(map_.keyframes().Contains(Id(1)));
  EXPECT_EQ(map_.landmarks().At(strong).observation_weight, 3);
  EXPECT_FALSE(map_.landmarks().Contains(weak));
  EXPECT_EQ(map_.keyframes().At(Id(2)).parent, Id(0));
  EXPECT_EQ(map_.keyframes().At(Id(0)).children, std::vector<KeyframeId>{Id(2)});
  EXPECT_EQ(map_.keyframes().NextId(), Id(4));  // its id is not used again
}

TEST_F(CulledKeyframes, KeepTheirPose) {
  std::vector<Rigid3> poses;
  for (int i = 0; i < 4; ++i) {
    poses.push_back(map_.CamFromWorld(Id(i)));
    EXPECT_EQ(Distance(poses.back(), map_.keyframes().At(Id(i)).cam_from_world), 0.0);
  }
  for (const int culled : {2, 1, 3}) {
    map_.CullKeyframe(Id(culled));
    for (int i = 0; i < 4; ++i) {
      EXPECT_LT(Distance(map_.CamFromWorld(Id(i)), poses[static_cast<size_t>(i)]), 1e-12);
    }
  }
}

TEST_F(CulledKeyframes, MoveWithTheirParent) {
  const Rigid3 relative = map_.CamFromWorld(Id(2)) * Inverse(map_.CamFromWorld(Id(1)));
  map_.CullKeyframe(Id(2));
  map_.SetPose(Id(1), random_.Pose(1.0, 2.0));
  EXPECT_LT(Distance(map_.CamFromWorld(Id(2)), relative * map_.CamFromWorld(Id(1))), 1e-12);
  // Also when the parent is culled later and then the root moves.
  map_.CullKeyframe(Id(1));
  map_.SetPose(Id(0), random_.Pose(1.0, 2.0));
  EXPECT_LT(Distance(map_.CamFromWorld(Id(2)), relative * map_.CamFromWorld(Id(1))), 1e-12);
}

// After a correction, keyframes of one map may have different scales.
TEST_F(CulledKeyframes, FollowTheScaleOfTheirParent) {
  const std::vector<double> scales = {1.0, 2.0, 0.5, 3.0};
  for (int i = 0; i < 4; ++i) {
    map_.MutableKeyframe(Id(i)).scale = scales[static_cast<size_t>(i)];
  }
  std::vector<Rigid3> poses;
  for (int i = 0; i < 4; ++i) {
    poses.push_back(map_.CamFromWorld(Id(i)));
  }
  for (const int culled : {2, 1}) {
    map_.CullKeyframe(Id(culled));
    for (int i = 0; i < 4; ++i) {
      EXPECT_DOUBLE_EQ(map_.ScaleOf(Id(i)), scales[static_cast<size_t>(i)]);
      EXPECT_LT(Distance(map_.CamFromWorld(Id(i)), poses[static_cast<size_t>(i)]), 1e-12);
    }
  }
  EXPECT_EQ(map_.FindCulled(Id(2))->scale, 0.5);
  map_.MutableKeyframe(Id(0)).scale = 4.0;
  EXPECT_DOUBLE_EQ(map_.ScaleOf(Id(1)), 8.0);
  EXPECT_DOUBLE_EQ(map_.ScaleOf(Id(2)), 2.0);
  EXPECT_DOUBLE_EQ(map_.ScaleOf(Id(3)), 3.0);
  Rigid3 relative = poses[2] * Inverse(poses[0]);
  relative.translation *= 4.0;
  EXPECT_LT(Distance(map_.CamFromWorld(Id(2)), relative * poses[0]), 1e-12);
}

TEST_F(CulledKeyframes, AreFoundByFindCulled) {
  map_.CullKeyframe(Id(2));
  ASSERT_NE(map_.FindCulled(Id(2)), nullptr);
  EXPECT_EQ(map_.FindCulled(Id(2))->pose.reference, Id(1));
  EXPECT_EQ(map_.FindCulled(Id(1)), nullptr);
  EXPECT_EQ(map_.FindCulled(Id(9)), nullptr);
}

TEST_F(CulledKeyframes, HandTheirLoopEdgesOver) {
  map_.AddLoop(Id(3), Id(0));
  map_.AddLoop(Id(3), Id(1));
  map_.CullKeyframe(Id(3));  // its parent is 2
  EXPECT_EQ(map_.keyframes().At(Id(2)).loops, (std::vector<KeyframeId>{Id(0), Id(1)}));
  EXPECT_EQ(map_.keyframes().At(Id(0)).loops, std::vector<KeyframeId>{Id(2)});
  EXPECT_EQ(map_.keyframes().At(Id(1)).loops, std::vector<KeyframeId>{Id(2)});
  // The edge to the parent itself is dropped.
  map_.CullKeyframe(Id(2));
  EXPECT_EQ(map_.keyframes().At(Id(1)).loops, std::vector<KeyframeId>{Id(0)});
  EXPECT_EQ(map_.keyframes().At(Id(0)).loops, std::vector<KeyframeId>{Id(1)});
  map_.CullKeyframe(Id(1));
  EXPECT_TRUE(map_.keyframes().At(Id(0)).loops.empty());
}

// Parents of parents could be far from where the loop was closed.
TEST(CulledKeyframesInARow, HandALoopEdgeToTheNeighbourThatIsNearestToItsOtherEnd) {
  Map map;
  for (int i = 0; i < 5; ++i) {  // at i metres
    const KeyframeId id =
        AddKeyframe(map, 60, 0, {Eigen::Quaterniond::Identity(), {-1.0 * i, 0.0, 0.0}});
    if (i > 0) {
      Share(map, {KeyframeId(id.value - 1), id}, 20);
      UpdateCovisibility(map, id);
    }
  }
  const KeyframeId back =
      AddKeyframe(map, 60, 0, {Eigen::Quaterniond::Identity(), {-2.1, 0.0, 0.0}});
  SetParent(map, back, KeyframeId(4));
  map.AddLoop(KeyframeId(2), back);
  ASSERT_EQ(map.keyframes().At(KeyframeId(2)).parent, KeyframeId(1));
  map.CullKeyframe(KeyframeId(2));
  EXPECT_EQ(map.keyframes().At(back).loops, std::vector<KeyframeId>{KeyframeId(3)});
  EXPECT_EQ(map.keyframes().At(KeyframeId(3)).loops, std::vector<KeyframeId>{back});
  EXPECT_TRUE(map.keyframes().At(KeyframeId(1)).loops.empty());
}

TEST(Map, ALoopEdgeIsAddedOnceAtBothEnds) {
  Map map;
  const KeyframeId a = AddKeyframe(map, 1);
  const KeyframeId b = AddKeyframe(map, 1);
  const KeyframeId c = AddKeyframe(map, 1);
  map.AddLoop(b, c);
  map.AddLoop(b, a);
  map.AddLoop(a, b);
  EXPECT_EQ(map.keyframes().At(b).loops, (std::vector<KeyframeId>{a, c}));
  EXPECT_EQ(map.keyframes().At(a).loops, std::vector<KeyframeId>{b});
  EXPECT_EQ(map.keyframes().At(c).loops, std::vector<KeyframeId>{b});
  EXPECT_THROW(map.AddLoop(a, a), CheckError);
  EXPECT_THROW(map.AddLoop(a, KeyframeId(9)), CheckError);
}

TEST(Map, CountsItsCorrections) {
  Map map;
  EXPECT_EQ(map.correction_count(), 0u);
  map.CountCorrection();
  EXPECT_EQ(map.correction_count(), 1u);
  EXPECT_EQ(map.Snapshot().correction_count(), 1u);
}

TEST_F(CulledKeyframes, HaveANearestAncestorInTheMap) {
  map_.CullKeyframe(Id(2));
  map_.CullKeyframe(Id(1));
  EXPECT_EQ(map_.NearestAlive(Id(2)), Id(0));
  EXPECT_EQ(map_.NearestAlive(Id(1)), Id(0));
  EXPECT_EQ(map_.NearestAlive(Id(3)), Id(3));
}

TEST_F(CulledKeyframes, AreNeverTheRoot) {
  EXPECT_THROW(map_.CullKeyframe(Id(0)), CheckError);
  EXPECT_TRUE(map_.keyframes().Contains(Id(0)));
  map_.CullKeyframe(Id(3));
  EXPECT_THROW(map_.CullKeyframe(Id(3)), CheckError);
}

TEST_F(CulledKeyframes, AreFoundByTheirFrame) {
  map_.CullKeyframe(Id(2));
  for (uint32_t frame = 0; frame < 5 * kFramesPerKeyframe; ++frame) {
    const auto found = map_.KeyframeOfFrame(FrameId(frame));
    const bool is_made = frame % kFramesPerKeyframe == 0 && frame < 4 * kFramesPerKeyframe;
    ASSERT_EQ(found.has_value(), is_made) << frame;
    if (is_made) {
      EXPECT_EQ(*found, KeyframeId(frame / kFramesPerKeyframe));
    }
  }
  EXPECT_FALSE(Map().KeyframeOfFrame(FrameId(0)).has_value());
}

TEST(MapSnapshot, DoesNotChangeWhenTheLiveMapDoes) {
  Map live;
  RandomEdits edits(1);
  for (int round = 0; round < 15; ++round) {
    const Map snapshot = live.Snapshot();
    const std::string before = Dump(snapshot);
    ASSERT_EQ(Dump(live), before);
    for (int i = 0; i < 30; ++i) {
      edits.Edit(live);
    }
    EXPECT_NE(Dump(live), before);
    ASSERT_EQ(Dump(snapshot), before);
  }
}

TEST(MapSnapshot, CanBeWrittenWithoutChangingTheLiveMap) {
  Map live;
  RandomEdits edits(2);
  for (int i = 0; i < 200; ++i) {
    edits.Edit(live);
  }
  const std::string before = Dump(live);
  Map snapshot = live.Snapshot();
  for (int i = 0; i < 200; ++i) {
    edits.Edit(snapshot);
  }
  EXPECT_NE(Dump(snapshot), before);
  EXPECT_EQ(Dump(live), before);
}

TEST(MapIndex, FindsKeyframesByTheirWords) {
  Map map(SharedVocabulary());
  const KeyframeId a = AddKeyframe(map, 40, 10);
  const KeyframeId b = AddKeyframe(map, 40, 10);
  SetParent(map, b, a);
  const Frame& frame = *map.keyframes().At(b).frame;
  const std::vector<SimilarKeyframe> similar = map.index().Query(map.VectorOf(frame));
  ASSERT_EQ(similar.size(), 2u);
  EXPECT_EQ(similar[0].keyframe, b);
  EXPECT_NEAR(similar[0].score, 1.0, 1e-6);
  EXPECT_LT(similar[1].score, 0.9);

  const Map before = map.Snapshot();
  EXPECT_EQ(before.vocabulary(), map.vocabulary());
  const BowVector vector = map.VectorOf(frame);
  map.CullKeyframe(b);
  ASSERT_EQ(map.index().Query(vector).size(), 1u);
  EXPECT_EQ(map.index().Query(vector)[0].keyframe, a);
  EXPECT_EQ(before.index().Query(vector).size(), 2u);
  EXPECT_TRUE(FindViolations(before).empty());
}

TEST(MapIndex, IsEmptyWithoutAVocabulary) {
  Map map;
  const auto frame = MakeFrame(0, 3);
  frame->words = std::vector{WordId(1), WordId(2), WordId(3)};
  map.AddKeyframe(frame, {});
  EXPECT_TRUE(map.VectorOf(*frame).empty());
  EXPECT_TRUE(map.index().postings().empty());
}

TEST(MapIndex, AFrameHasOneWordPerKeypointOrNone) {
  Map map(SharedVocabulary());
  const auto frame = MakeFrame(0, 3);
  frame->words = std::vector{WordId(1)};
  EXPECT_THROW(map.AddKeyframe(frame, {}), CheckError);
  frame->words = {};
  map.AddKeyframe(frame, {});
  EXPECT_TRUE(map.index().postings().empty());
}

TEST(MapIndex, StaysConsistentUnderRandomEdits) {
  Map map(SharedVocabulary());
  RandomEdits edits(5);
  for (int i = 0; i < 400; ++i) {
    edits.Edit(map);
  }
  EXPECT_GT(map.index().postings().size(), 20u);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
}

TEST(Map, SessionsBeginAfterAllFrames) {
  Map map;
  EXPECT_EQ(map.NextFrame(), FrameId(0));
  map.BeginSession({"a", FrameId(0)});
  AddKeyframe(map, 10);
  const KeyframeId second = AddKeyframe(map, 10);
  EXPECT_EQ(map.NextFrame(), FrameId(kFramesPerKeyframe + 1));
  EXPECT_THROW(map.BeginSession({"b", FrameId(kFramesPerKeyframe)}), CheckError);
  EXPECT_THROW(map.BeginSession({"b", FrameId()}), CheckError);
  map.BeginSession({"b", FrameId(10)});
  EXPECT_THROW(map.BeginSession({"c", FrameId(10)}), CheckError);
  SetParent(map, second, KeyframeId(0));
  map.CullKeyframe(second);
  EXPECT_EQ(map.NextFrame(), FrameId(kFramesPerKeyframe + 1)) << "culled keyframes count";
  EXPECT_EQ(map.Snapshot().sessions(), map.sessions());
}

}  // namespace
}  // namespace hullslam

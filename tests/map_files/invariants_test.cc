// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_files/invariants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "map/keyframe_graph.h"
#include "map/made_map.h"
#include "map/random_edits.h"
#include "support/made_vocabulary.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class Invariants : public ::testing::Test {
 protected:
  Invariants() {
    for (int i = 0; i < 3; ++i) {
      AddKeyframe(map_, 40, 10);
    }
    shared_ = Share(map_, {a_, b_, c_}, 20);
    for (const KeyframeId id : {a_, b_, c_}) {
      UpdateCovisibility(map_, id);
    }
  }

  // Expects faults, one of them with this message.
  void ExpectViolation(const std::string& words) {
    const std::vector<std::string> violations = FindViolations(map_);
    const bool found =
        std::any_of(violations.begin(), violations.end(),
                    [&](const std::string& text) { return text.find(words) != std::string::npos; });
    EXPECT_TRUE(found) << "not found: " << words << ::testing::PrintToString(violations);
  }

  Map map_;
  const KeyframeId a_{0};
  const KeyframeId b_{1};
  const KeyframeId c_{2};
  std::vector<LandmarkId> shared_;
};

TEST_F(Invariants, HoldForAConsistentMap) {
  EXPECT_TRUE(FindViolations(Map()).empty());
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
}

TEST_F(Invariants, FindAnObservationMissingInTheKeyframe) {
  map_.MutableKeyframe(b_).landmarks[3] = LandmarkId();
  ExpectViolation("landmark 3 is not observed by keyframe 1");
}

TEST_F(Invariants, FindAnObservationMissingInTheLandmark) {
  map_.MutableKeyframe(b_).landmarks[30] = shared_[3];
  ExpectViolation("keyframe 1 observes landmark 3, which has no such observation");
}

TEST_F(Invariants, FindAnObservationOfAMissingLandmark) {
  map_.MutableKeyframe(b_).landmarks[30] = LandmarkId(999);
  ExpectViolation("keyframe 1 observes landmark 999, which has no such observation");
}

TEST_F(Invariants, FindAnObservationByAMissingKeyframeOrKeypoint) {
  map_.MutableLandmark(shared_[0]).observations[2].keyframe = KeyframeId(99);
  ExpectViolation("landmark 0 is not observed by keyframe 99");
  map_.MutableLandmark(shared_[1]).observations[0].keypoint = 99;
  ExpectViolation("landmark 1 is not observed by keyframe 0");
}

TEST_F(Invariants, FindObservationsOutOfOrder) {
  auto& observations = map_.MutableLandmark(shared_[0]).observations;
  std::swap(observations[0], observations[1]);
  ExpectViolation("landmark 0 has observations out of order");
}

TEST_F(Invariants, FindAWrongObservationWeight) {
  ++map_.MutableLandmark(shared_[15]).observation_weight;
  ExpectViolation("landmark 15 has a wrong observation weight");
}

TEST_F(Invariants, FindMissingEntries) {
  map_.MutableKeyframe(c_).landmarks.pop_back();
  ExpectViolation("keyframe 2 does not have one landmark entry per keypoint");
}

TEST_F(Invariants, FindEdgesKnownAtOneEnd) {
  map_.MutableKeyframe(a_).covisible[0].shared += 1;
  ExpectViolation("keyframe 0 has an edge that keyframe 1 does not have");
  map_.MutableKeyframe(c_).covisible.clear();
  ExpectViolation("keyframe 0 has an edge that keyframe 2 does not have");
  map_.MutableKeyframe(b_).covisible.push_back({KeyframeId(99), 20});
  ExpectViolation("keyframe 1 has an edge that keyframe 99 does not have");
}

TEST_F(Invariants, FindTreeLinksKnownAtOneEnd) {
  map_.MutableKeyframe(c_).children.push_back(KeyframeId(99));
  ExpectViolation("keyframe 2 has a child with another parent: keyframe 99");
  map_.MutableKeyframe(a_).children.clear();
  ExpectViolation("keyframe 1 is not a child of its parent");
  map_.MutableKeyframe(b_).parent = KeyframeId(99);
  ExpectViolation("keyframe 1 is not a child of its parent");
}

TEST_F(Invariants, FindACycleInTheTree) {
  SetParent(map_, a_, c_);
  SetParent(map_, c_, b_);
  SetParent(map_, b_, a_);
  ExpectViolation("keyframe 0 is its own ancestor");
}

TEST_F(Invariants, FindASecondRootOfAnIsland) {
  SetParent(map_, c_, KeyframeId());
  ExpectViolation("keyframe 2 is a second root of the island of keyframe 0");
  Map map;
  const KeyframeId first = AddKeyframe(map, 1);
  map.BeginIsland();
  map.AddKeyframe(MakeFrame(9, 1), {}, map.BeginIsland());
  EXPECT_EQ(FindViolations(map), std::vector<std::string>()) << "each island has a root";
  map.MoveToIsland(first, IslandId(1));
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
}

TEST_F(Invariants, FindValuesThatAreNotFinite) {
  map_.SetPosition(shared_[7], {0.0, kNan, 0.0});
  ExpectViolation("landmark 7 has no finite position");
  Rigid3 pose;
  pose.rotation.x() = kNan;
  map_.SetPose(b_, pose);
  ExpectViolation("keyframe 1 has no finite pose");
  map_.SetPose(c_, {Eigen::Quaterniond::Identity(), {kNan, 0.0, 0.0}});
  ExpectViolation("keyframe 2 has no finite pose");
}

TEST(InvariantsAfterRandomEdits, Hold) {
  for (uint32_t seed = 0; seed < 30; ++seed) {
    Map map;
    RandomEdits edits(seed);
    for (int i = 0; i < 300; ++i) {
      edits.Edit(map);
      ASSERT_EQ(FindViolations(map), std::vector<std::string>()) << "seed " << seed << ", " << i;
    }
    EXPECT_GT(map.keyframes().NextId().value, map.keyframes().size()) << "nothing was culled";
  }
}

// The order is not that of mapping: first all observations, then covisibility of all keyframes.
TEST(InvariantsOfTheSyntheticMap, Hold) {
  const SyntheticWorld world;
  const SyntheticMap made = MakeSyntheticMap(world, {0, 5, 10, 15, 20, 25, 30});
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  made.map.keyframes().ForEach([](KeyframeId id, const Keyframe& keyframe) {
    EXPECT_EQ(keyframe.parent.IsValid(), id != KeyframeId(0)) << id.value;
  });
}

TEST_F(Invariants, FindAnObjectMissingInTheKeyframe) {
  const ObjectId object = map_.AddObject();
  ASSERT_TRUE(map_.AddObservation(object, b_, 1));
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
  map_.MutableKeyframe(b_).objects[1] = ObjectId();
  ExpectViolation("object 0 is not observed by keyframe 1");
}

TEST_F(Invariants, FindADetectionOfAMissingObject) {
  map_.MutableKeyframe(a_).objects[2] = ObjectId(7);
  ExpectViolation("keyframe 0 observes object 7, which has no such observation");
}

TEST_F(Invariants, FindADetectionOfAMissingKeypoint) {
  auto frame = std::make_shared<Frame>(*map_.keyframes().At(a_).frame);
  frame->detections[1].keypoints = {0, static_cast<uint32_t>(frame->features.size())};
  map_.MutableKeyframe(a_).frame = frame;
  ExpectViolation("keyframe 0 has a detection of a keypoint that it does not have");
}

TEST_F(Invariants, FindWrongVotes) {
  const ObjectId object = map_.AddObject();
  ASSERT_TRUE(map_.AddObservation(object, b_, 1));
  map_.MutableObject(object).votes["cup"] += 1.0;
  ExpectViolation("object 0 has wrong votes");
}

TEST_F(Invariants, FindAWrongReferenceOfAnObject) {
  const ObjectId object = map_.AddObject();
  map_.MutableObject(object).reference = KeyframeId(99);
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());  // nothing observes it
  ASSERT_TRUE(map_.AddObservation(object, a_, 1));
  ASSERT_TRUE(map_.AddObservation(object, b_, 1));
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
  map_.MutableObject(object).reference = b_;
  ExpectViolation("object 0 has a reference that is not the first to observe it");
}

TEST_F(Invariants, FindWrongLoopEdges) {
  map_.AddLoop(a_, b_);
  map_.AddLoop(a_, c_);
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
  map_.MutableKeyframe(a_).loops = {c_, b_};
  ExpectViolation("keyframe 0 has loop edges out of order");
  map_.MutableKeyframe(a_).loops = {b_, b_, c_};
  ExpectViolation("keyframe 0 has loop edges out of order");
  map_.MutableKeyframe(a_).loops = {c_};
  ExpectViolation("keyframe 1 has a loop edge that keyframe 0 does not have");
  map_.MutableKeyframe(b_).loops = {b_};
  ExpectViolation("keyframe 1 has a loop edge that keyframe 1 does not have");
  map_.MutableKeyframe(c_).loops = {KeyframeId(99)};
  ExpectViolation("keyframe 2 has a loop edge that keyframe 99 does not have");
}

TEST_F(Invariants, FindAScaleThatIsNotPositive) {
  for (const double scale : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
    map_.MutableKeyframe(b_).scale = scale;
    ExpectViolation("keyframe 1 has no finite scale above 0");
  }
}

TEST_F(Invariants, FindAMappedObjectThatNoKeyframeObserves) {
  const ObjectId object = map_.AddObject();
  ASSERT_TRUE(map_.AddObservation(object, a_, 0));
  map_.MutableObject(object).has_shape = true;
  map_.MutableObject(object).state = ObjectState::kMapped;
  map_.RemoveObservation(object, a_);  // makes it a candidate
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
  map_.MutableObject(object).state = ObjectState::kMapped;
  ExpectViolation("object 0 is mapped although no keyframe observes it");
}

TEST_F(Invariants, FindAMissingOrInvalidShape) {
  const ObjectId object = map_.AddObject();
  ASSERT_TRUE(map_.AddObservation(object, a_, 0));
  map_.MutableObject(object).state = ObjectState::kMapped;
  ExpectViolation("object 0 is mapped without a shape");
  map_.MutableObject(object).has_shape = true;
  EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
  map_.MutableObject(object).ellipsoid.half_axes.x() = kNan;
  ExpectViolation("object 0 has no finite shape");
}

// Frames are shared as constants, but these tests made them.
Frame& FrameOf(Map& map, KeyframeId id) {
  return const_cast<Frame&>(*map.keyframes().At(id).frame);
}

TEST(InvariantsOfTheIndex, FindWordsThatTheIndexDoesNotHave) {
  Map map(SharedVocabulary());
  const KeyframeId id = AddKeyframe(map, 40, 10);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  std::vector<WordId> words = FrameOf(map, id).words.get();
  words[0] = WordId(63);
  FrameOf(map, id).words = std::move(words);
  const std::vector<std::string> violations = FindViolations(map);
  ASSERT_FALSE(violations.empty());
  EXPECT_EQ(violations[0], "keyframe 0 has words that the index does not have");
}

TEST(InvariantsOfTheIndex, FindEntriesOfNoKeyframe) {
  Map map(SharedVocabulary());
  const KeyframeId id = AddKeyframe(map, 1);
  FrameOf(map, id).words = {};
  EXPECT_EQ(FindViolations(map), std::vector<std::string>{"the index has 1 entries, expected 0"});
}

TEST_F(Invariants, NothingLeadsToAnotherIsland) {
  map_.MoveToIsland(c_, map_.BeginIsland());
  ExpectViolation("keyframe 2 observes landmark 0 of another island");
  ExpectViolation("keyframe 2 has an edge to another island");
  const ObjectId object = map_.AddObject();
  map_.AddObservation(object, a_, 0);
  map_.AddObservation(object, c_, 0);
  ExpectViolation("keyframe 2 observes object 0 of another island");
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "loop/ring_islands.h"
#include "loop/ring_things.h"
#include "map/correction.h"
#include "map/islands.h"
#include "map/made_map.h"
#include "map_files/invariants.h"
#include "places/similar_places.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

// A loop between two keyframes that is exactly right.
Loop TrueLoop(const RingMap& made, uint32_t query, uint32_t candidate) {
  Loop loop;
  loop.query = KeyframeId(query);
  loop.candidate = KeyframeId(candidate);
  loop.query_from_candidate =
      Sim3(made.true_cam_from_world[query] * Inverse(made.true_cam_from_world[candidate]));
  return loop;
}

Map Corrected(RingMap& made, const MapCorrection& correction) {
  Map corrected = made.map.Snapshot();
  EXPECT_TRUE(ApplyCorrection(corrected, correction, SharedRing().sensor().levels).is_applied);
  return corrected;
}

TEST(KeyframesAround, AreTheKeyframeAndAllThatAreCovisibleById) {
  const RingMap made = MakeRingMap(SharedRing());
  const Keyframe& keyframe = made.map.keyframes().At(KeyframeId(12));
  const std::vector<KeyframeId> around = KeyframesAround(made.map, KeyframeId(12));
  EXPECT_EQ(around.size(), keyframe.covisible.size() + 1);
  EXPECT_TRUE(std::is_sorted(around.begin(), around.end()));
  EXPECT_TRUE(std::binary_search(around.begin(), around.end(), KeyframeId(12)));
  for (const Covisible& other : keyframe.covisible) {
    EXPECT_TRUE(std::binary_search(around.begin(), around.end(), other.keyframe));
  }
}

TEST(SpreadLoopError, RemovesTheDriftAtTheEndAndMuchOfItBetween) {
  RingMap made = MakeRingMap(SharedRing());
  const Map corrected = Corrected(made, SpreadLoopError(made.map, TrueLoop(made, 29, 5), true));
  EXPECT_EQ(FindViolations(corrected), std::vector<std::string>());
  double before = 0.0;
  double after = 0.0;
  for (uint32_t i = 0; i < 30; ++i) {
    before += PoseError(made, made.map, KeyframeId(i));
    after += PoseError(made, corrected, KeyframeId(i));
  }
  EXPECT_LT(PoseError(made, corrected, made.last()), 0.1 * PoseError(made, made.map, made.last()));
  EXPECT_LT(after, 0.5 * before);
}

// The drift grows from keyframe 8 to 16. The poses within both parts of the map are kept.
TEST(SpreadLoopError, IsTakenByAKeyframeThatIsTied) {
  RingMap made = MakeRingMap(SharedRing(), {.tied = 12});
  const Map corrected = Corrected(made, SpreadLoopError(made.map, TrueLoop(made, 29, 5), true));
  EXPECT_LT(PoseError(made, corrected, made.last()), 1e-3);
  for (uint32_t i = 0; i < 29; ++i) {
    const auto step = [&](const Map& map) {
      return map.CamFromWorld(KeyframeId(i + 1)) * Inverse(map.CamFromWorld(KeyframeId(i)));
    };
    const Rigid3 change = step(corrected) * Inverse(step(made.map));
    EXPECT_EQ(change.translation.norm() > 1e-3, i == 11) << i;
  }
}

TEST(SpreadLoopError, NamesTheLoopAndAllKeyframesAsTheyAreInTheSnapshot) {
  RingMap made = MakeRingMap(SharedRing());
  made.map.CountCorrection();
  const MapCorrection correction = SpreadLoopError(made.map, TrueLoop(made, 29, 5), true);
  EXPECT_EQ(correction.snapshot_corrections, 1u);
  ASSERT_TRUE(correction.loop);
  EXPECT_EQ(std::max(correction.loop->a, correction.loop->b), KeyframeId(29));
  EXPECT_EQ(std::min(correction.loop->a, correction.loop->b), KeyframeId(5));
  EXPECT_TRUE(correction.landmarks.empty());
  ASSERT_EQ(correction.poses.size(), 30u);
  for (uint32_t i = 0; i < 30; ++i) {
    const MapCorrection::Pose& pose = correction.poses[i];
    EXPECT_EQ(pose.keyframe, KeyframeId(i));
    const Rigid3& in_map = made.map.keyframes().At(KeyframeId(i)).cam_from_world;
    EXPECT_EQ(pose.snapshot_cam_from_world.rotation.coeffs(), in_map.rotation.coeffs());
    EXPECT_EQ(pose.snapshot_cam_from_world.translation, in_map.translation);
    EXPECT_EQ(pose.corrected_cam_from_world.scale, 1.0);
  }
}

TEST(SpreadLoopError, TheRootStaysToTheLastBit) {
  RingMap made = MakeRingMap(SharedRing());
  for (const uint32_t candidate : {3u, 5u}) {
    const MapCorrection correction = SpreadLoopError(made.map, TrueLoop(made, 28, candidate), true);
    const MapCorrection::Pose& root = correction.poses.front();
    EXPECT_EQ(root.corrected_cam_from_world.rotation.coeffs(),
              root.snapshot_cam_from_world.rotation.coeffs());
    EXPECT_EQ(root.corrected_cam_from_world.translation, root.snapshot_cam_from_world.translation);
    EXPECT_NE(correction.poses.back().corrected_cam_from_world.translation,
              correction.poses.back().snapshot_cam_from_world.translation);
  }
}

TEST(SpreadLoopError, AMapWithoutDriftStaysAsItIs) {
  RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()});
  const Map corrected = Corrected(made, SpreadLoopError(made.map, TrueLoop(made, 29, 5), true));
  for (uint32_t i = 0; i < 30; ++i) {
    EXPECT_LT(PoseError(made, corrected, KeyframeId(i)), 1e-9) << i;
  }
}

// A loop in the middle of the path moves keyframe 16. Keyframes that an earlier loop connects to an
// old keyframe do not follow it.
TEST(SpreadLoopError, EarlierLoopsHoldTheMap) {
  const auto moved = [](bool has_loop) {
    RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()});
    if (has_loop) {
      made.map.AddLoop(KeyframeId(2), KeyframeId(26));
    }
    Loop loop = TrueLoop(made, 16, 4);
    loop.query_from_candidate.translation += Eigen::Vector3d(0.3, 0.0, 0.0);
    const Map corrected = Corrected(made, SpreadLoopError(made.map, loop, true));
    return PoseError(made, corrected, KeyframeId(26));
  };
  EXPECT_GT(moved(false), 0.2);
  EXPECT_LT(moved(true), 0.05);
}

// The keyframes between the ends of the loop have scales between those of its ends.
TEST(SpreadLoopError, AnErrorOfScaleIsSpreadOverTheWay) {
  constexpr double kScale = 0.8;
  RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()});
  Loop loop = TrueLoop(made, 29, 5);
  loop.query_from_candidate =
      Sim3(kScale, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()) *
      loop.query_from_candidate;
  const MapCorrection correction = SpreadLoopError(made.map, loop, false);
  ASSERT_EQ(correction.poses.size(), 30u);
  EXPECT_NEAR(correction.poses[5].corrected_cam_from_world.scale, 1.0, 0.02);
  EXPECT_NEAR(correction.poses[29].corrected_cam_from_world.scale, kScale, 0.02);
  for (uint32_t i = 6; i < 29; ++i) {
    EXPECT_LT(correction.poses[i].corrected_cam_from_world.scale,
              correction.poses[i - 1].corrected_cam_from_world.scale)
        << i;
  }
}

class LoopMerges : public testing::Test {
 protected:
  LoopMerges() {
    const Loop loop = TrueLoop(made_, 29, 5);
    correction_ = SpreadLoopError(made_.map, loop, true);
    // The spread error still leaves landmarks of the neighbours some pixels apart.
    Sensor sensor = SharedRing().sensor();
    sensor.depth_error.pixel_sigma = 0.7;
    AddMerges(Corrected(made_, correction_), sensor, loop, {}, correction_);
  }
  uint32_t PointOf(LandmarkId id) const {
    const Observation& seen = made_.map.landmarks().At(id).observations.front();
    return made_.views[seen.keyframe.value].points[seen.keypoint];
  }
  KeyframeId NewestObserver(LandmarkId id) const {
    return made_.map.landmarks().At(id).observations.back().keyframe;
  }

  RingMap made_ = MakeRingMap(SharedRing(), {}, ThreeThings());
  MapCorrection correction_;
};

TEST_F(LoopMerges, JoinLandmarksOfOnePoint) {
  EXPECT_GT(correction_.landmarks.size(), 150u);
  IdSet<LandmarkId> merged;
  for (const auto& [duplicate, kept] : correction_.landmarks) {
    EXPECT_EQ(PointOf(duplicate), PointOf(kept));
    EXPECT_TRUE(merged.Insert(duplicate)) << "twice: " << duplicate.value;
    EXPECT_LT(NewestObserver(kept), KeyframeId(12)) << "the older one is kept";
    EXPECT_GE(NewestObserver(duplicate), KeyframeId(24));
  }
}

// Landmarks that only the neighbours of the query see are merged too.
TEST_F(LoopMerges, JoinTheNeighbourhoodToo) {
  const std::vector<LandmarkId>& of_query = made_.map.keyframes().At(KeyframeId(29)).landmarks;
  EXPECT_TRUE(std::any_of(
      correction_.landmarks.begin(), correction_.landmarks.end(), [&](const auto& merge) {
        return std::find(of_query.begin(), of_query.end(), merge.duplicate) == of_query.end();
      }));
}

TEST_F(LoopMerges, JoinObjectsThatAreOneThing) {
  ASSERT_EQ(made_.map.objects().size(), 6u);
  ASSERT_EQ(correction_.objects.size(), 3u);
  for (const auto& [duplicate, kept] : correction_.objects) {
    EXPECT_EQ(made_.map.objects().At(duplicate).Label(), made_.map.objects().At(kept).Label());
  }
}

TEST_F(LoopMerges, AreAppliedToAConsistentMapWithOneLandmarkPerPoint) {
  const Map merged = Corrected(made_, correction_);
  EXPECT_EQ(FindViolations(merged), std::vector<std::string>());
  EXPECT_EQ(merged.objects().size(), 3u);
  EXPECT_EQ(merged.landmarks().size(), made_.map.landmarks().size() - correction_.landmarks.size());
  const Keyframe& query = merged.keyframes().At(KeyframeId(29));
  EXPECT_TRUE(std::any_of(query.covisible.begin(), query.covisible.end(), [](const Covisible& c) {
    return c.keyframe == KeyframeId(5) && c.shared > 100;
  })) << "both ends see the same landmarks now";
}

// Either end of the loop may belong to the younger island. The younger island moves.
TEST(MoveIsland, MovesTheYoungerIslandToItsTruePoseAndLeavesTheOther) {
  const Sim3 island_from_world(2.5, ExpSo3({0.3, -0.4, 0.2}), {3.0, -1.0, 0.5});
  for (const bool query_is_younger : {true, false}) {
    RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()});
    SplitRing(made, 15, island_from_world);
    ASSERT_EQ(FindViolations(made.map), std::vector<std::string>());
    Loop loop = TrueLoop(made, query_is_younger ? 29 : 5, query_is_younger ? 5 : 29);
    // Lengths in the younger island are 2.5 times as long.
    const Sim3 unit(2.5, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero());
    loop.query_from_candidate = query_is_younger ? unit * loop.query_from_candidate
                                                 : loop.query_from_candidate * Inverse(unit);
    const MapCorrection correction = MoveIsland(made.map, loop);
    ASSERT_EQ(correction.poses.size(), 15u);
    EXPECT_EQ(correction.poses.front().keyframe, KeyframeId(15));
    EXPECT_EQ(correction.snapshot_corrections, made.map.correction_count());
    const Map corrected = Corrected(made, correction);
    EXPECT_EQ(FindViolations(corrected), std::vector<std::string>());
    EXPECT_EQ(Islands(corrected).size(), 1u);
    EXPECT_EQ(corrected.keyframes().At(KeyframeId(29)).parent, KeyframeId(5));
    for (uint32_t i = 0; i < 30; ++i) {
      EXPECT_LT(PoseError(made, corrected, KeyframeId(i)), 1e-9) << i;
      EXPECT_NEAR(corrected.ScaleOf(KeyframeId(i)), 1.0, 1e-12) << i;
    }
  }
}

TEST(SpreadLoopError, NamesTheIslandOfTheLoopOnly) {
  RingMap made = MakeRingMap(SharedRing());
  SplitRing(made, 28, Sim3(2.0, Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0}));
  const MapCorrection correction = SpreadLoopError(made.map, TrueLoop(made, 26, 3), true);
  ASSERT_EQ(correction.poses.size(), 28u);
  EXPECT_EQ(correction.poses.back().keyframe, KeyframeId(27));
}

// The first ten keyframes of a ring, all but the first two of them moved by up to a few
// centimetres.
class WholeMapAdjustment : public testing::Test {
 protected:
  WholeMapAdjustment() {
    RandomGeometry random(1);
    for (uint32_t i = 2; i < 10; ++i) {
      const KeyframeId id(i);
      made_.map.SetPose(id, random.Pose(0.01, 0.03) * made_.map.CamFromWorld(id));
    }
  }
  std::optional<MapCorrection> Adjust(const Cancellation* cancellation = nullptr) const {
    return AdjustWholeMap(made_.map, SharedRing().sensor(), {}, cancellation);
  }
  double Error(const Map& map) const {
    double sum = 0.0;
    for (uint32_t i = 0; i < 10; ++i) {
      sum += PoseError(made_, map, KeyframeId(i));
    }
    return sum;
  }

  RingMap made_ = MakeRingMap(
      SharedRing(), {.keyframes = 10, .drift = Rigid3(), .has_vocabulary = false}, ThreeThings());
};

TEST_F(WholeMapAdjustment, MovesKeyframesBackToTheirTruePoses) {
  const std::optional<MapCorrection> correction = Adjust();
  ASSERT_TRUE(correction);
  EXPECT_FALSE(correction->loop);
  EXPECT_FALSE(correction->positions.empty());
  Map map = made_.map.Snapshot();
  ASSERT_TRUE(ApplyCorrection(map, *correction, SharedRing().sensor().levels).is_applied);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  EXPECT_LT(Error(map), 0.1 * Error(made_.map));
}

TEST_F(WholeMapAdjustment, MovesEveryKeyframeButTheRoot) {
  const std::optional<MapCorrection> correction = Adjust();
  ASSERT_TRUE(correction);
  Map map = made_.map.Snapshot();
  ASSERT_TRUE(ApplyCorrection(map, *correction, SharedRing().sensor().levels).is_applied);
  for (uint32_t i = 0; i < 10; ++i) {
    const Rigid3 before = made_.map.CamFromWorld(KeyframeId(i));
    const Rigid3 after = map.CamFromWorld(KeyframeId(i));
    EXPECT_EQ(before.translation == after.translation, i == 0) << i;
    EXPECT_EQ(before.rotation.coeffs() == after.rotation.coeffs(), i == 0) << i;
  }
}

TEST_F(WholeMapAdjustment, RefersToTheSnapshotThatItWasGiven) {
  made_.map.CountCorrection();
  const std::optional<MapCorrection> correction = Adjust();
  ASSERT_TRUE(correction);
  EXPECT_EQ(correction->snapshot_corrections, 1u);
  for (const MapCorrection::Pose& pose : correction->poses) {
    EXPECT_EQ(pose.snapshot_cam_from_world.translation,
              made_.map.CamFromWorld(pose.keyframe).translation);
  }
}

TEST_F(WholeMapAdjustment, IsNullIfItWasCancelled) {
  Cancellation cancellation;
  EXPECT_TRUE(Adjust(&cancellation));
  cancellation.Request();
  EXPECT_FALSE(Adjust(&cancellation));
}

TEST_F(WholeMapAdjustment, TheSameInputGivesTheSameBits) {
  const auto dump = [&] {
    Map map = made_.map.Snapshot();
    ApplyCorrection(map, *Adjust(), SharedRing().sensor().levels);
    return Dump(map);
  };
  EXPECT_EQ(dump(), dump());
}

TEST(WholeMapAdjustmentOfIslands, AdjustsEachByItself) {
  RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3(), .has_vocabulary = false});
  const Sim3 island_from_world(2.0, ExpSo3({0.0, 0.5, 0.0}), {5.0, 0.0, 0.0});
  SplitRing(made, 15, island_from_world);
  Map truth = made.map.Snapshot();
  Sensor sensor = SharedRing().sensor();
  sensor.kind = SensorKind::kMonocular;
  RandomGeometry random(1);
  for (const uint32_t i : {4u, 5u, 20u, 21u}) {
    made.map.SetPose(KeyframeId(i), random.Pose(0.01, 0.02) * truth.CamFromWorld(KeyframeId(i)));
  }
  const std::optional<MapCorrection> correction = AdjustWholeMap(made.map, sensor, {}, nullptr);
  ASSERT_TRUE(correction);
  ASSERT_EQ(correction->poses.size(), 28u) << "all but the two roots";
  ASSERT_TRUE(ApplyCorrection(made.map, *correction, sensor.levels).is_applied);
  for (uint32_t i = 0; i < 30; ++i) {
    EXPECT_LT((made.map.CamFromWorld(KeyframeId(i)).translation -
               truth.CamFromWorld(KeyframeId(i)).translation)
                  .norm(),
              i < 15 ? 0.02 : 0.05)
        << i;
  }
}

}  // namespace

}  // namespace hullslam

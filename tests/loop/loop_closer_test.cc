// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_closer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "loop/loop_correction.h"
#include "loop/loop_verification.h"
#include "loop/ring_islands.h"
#include "loop/ring_things.h"
#include "map/correction.h"
#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/made_map.h"
#include "map_files/invariants.h"

namespace hullslam {
namespace {

class LoopCloserTest : public testing::Test {
 protected:
  LoopCloser Make() const { return {SharedRing().sensor(), options_, objects_, 1}; }
  // The correction of a new loop closer.
  std::optional<MapCorrection> Close(RingMap& made) const {
    return Make().Process({made.map.Snapshot(), made.last()});
  }
  // Whether a loop is found in a map with these things.
  bool Closes(const std::vector<RingThing>& things) const {
    RingMap made = MakeRingMap(SharedRing(), {}, things);
    return Close(made).has_value();
  }
  static Map Corrected(RingMap& made, const MapCorrection& correction) {
    Map map = made.map.Snapshot();
    EXPECT_TRUE(ApplyCorrection(map, correction, SharedRing().sensor().levels).is_applied);
    return map;
  }

  LoopOptions options_;
  ObjectOptions objects_;
};

TEST_F(LoopCloserTest, RemovesTheDriftAndJoinsBothEnds) {
  RingMap made = MakeRingMap(SharedRing(), {}, ThreeThings());
  const std::optional<MapCorrection> correction = Close(made);
  ASSERT_TRUE(correction);
  const Map map = Corrected(made, *correction);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  EXPECT_LT(PoseError(made, map, made.last()), 0.1 * PoseError(made, made.map, made.last()));
  EXPECT_EQ(map.CamFromWorld(KeyframeId(0)).translation,
            made.map.CamFromWorld(KeyframeId(0)).translation);
  EXPECT_EQ(map.CamFromWorld(KeyframeId(0)).rotation.coeffs(),
            made.map.CamFromWorld(KeyframeId(0)).rotation.coeffs());
  EXPECT_LT(map.landmarks().size(), made.map.landmarks().size() - 150);
  EXPECT_EQ(map.objects().size(), 3u);
  EXPECT_EQ(map.keyframes().At(made.last()).loops.size(), 1u);
}

// The pose graph spreads the error evenly over the path. The adjustment also uses the landmarks,
// which determine where the error arose.
TEST_F(LoopCloserTest, AfterTheAdjustmentOfTheWholeMapNoKeyframeHasDrifted) {
  RingMap made = MakeRingMap(SharedRing());
  const std::optional<MapCorrection> correction = Close(made);
  ASSERT_TRUE(correction);
  Map map = Corrected(made, *correction);
  const std::optional<MapCorrection> adjustment =
      AdjustWholeMap(map, SharedRing().sensor(), objects_, nullptr);
  ASSERT_TRUE(adjustment);
  ASSERT_TRUE(ApplyCorrection(map, *adjustment, SharedRing().sensor().levels).is_applied);
  const double drift = PoseError(made, made.map, made.last());
  for (uint32_t i = 0; i < 30; ++i) {
    EXPECT_LT(PoseError(made, map, KeyframeId(i)), 0.1 * drift) << i;
  }
}

TEST_F(LoopCloserTest, DoesNotChangeTheMapOfTheCaller) {
  RingMap made = MakeRingMap(SharedRing());
  const std::string before = Dump(made.map);
  EXPECT_TRUE(Close(made));
  EXPECT_EQ(Dump(made.map), before);
}

TEST_F(LoopCloserTest, APlaceThatIsSeenOnceClosesNoLoop) {
  RingMap made = MakeRingMap(SharedRing(), {.keyframes = 20});
  LoopCloser closer = Make();
  for (uint32_t i = 0; i < 20; ++i) {
    EXPECT_FALSE(closer.Process({made.map.Snapshot(), KeyframeId(i)})) << i;
  }
}

TEST_F(LoopCloserTest, WithoutAVocabularyOrSwitchedOffThereAreNoLoops) {
  RingMap without = MakeRingMap(SharedRing(), {.has_vocabulary = false});
  EXPECT_FALSE(Close(without));
  RingMap made = MakeRingMap(SharedRing());
  EXPECT_TRUE(Close(made));
  options_.enabled = false;
  EXPECT_FALSE(Close(made));
}

// Two rooms that look the same, 5 m apart.
TEST_F(LoopCloserTest, RefusesALoopThatDriftCannotExplain) {
  RingMap made =
      MakeRingMap(SharedRing(), {.drift = Rigid3(Eigen::Quaterniond::Identity(), {5.0, 0.0, 0.0})});
  EXPECT_FALSE(Close(made));
  options_.drift_base = 6.0;
  EXPECT_TRUE(Close(made)) << "without the budget the loop is closed";
  RingMap turned =
      MakeRingMap(SharedRing(), {.drift = Rigid3(ExpSo3({0.0, 0.8, 0.0}), {0.0, 0.0, 0.0})});
  EXPECT_FALSE(Close(turned));
  options_.turn_base = 1.0;
  EXPECT_TRUE(Close(turned));
}

// A motion prior that was wrong may have placed the second part anywhere.
TEST_F(LoopCloserTest, TheBudgetDoesNotCountPartsThatAreTiedByAPose) {
  RingMap made = MakeRingMap(
      SharedRing(), {.drift = Rigid3(ExpSo3({0.0, 0.8, 0.0}), {5.0, 0.0, 0.0}), .tied = 12});
  const std::optional<MapCorrection> correction = Close(made);
  ASSERT_TRUE(correction);
  const Map map = Corrected(made, *correction);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  EXPECT_LT(PoseError(made, map, made.last()), 0.1);
}

TEST_F(LoopCloserTest, OtherObjectsAtTheSamePlaceSpeakAgainstALoop) {
  EXPECT_TRUE(Closes(ThreeThings()));
  std::vector<RingThing> things = ThreeThings();
  things[0].is_at_last = false;
  EXPECT_TRUE(Closes(things)) << "one thing may have been taken away";
  things[1].is_at_last = false;
  things[2].is_at_last = false;
  EXPECT_FALSE(Closes(things));
}

// The bound is set to the number of landmarks that the query finds at the place. This is just
// enough with supporters and without objects.
TEST_F(LoopCloserTest, ObjectsAndSupportersDecideHowManyLandmarksAreNeeded) {
  const RingMap made = MakeRingMap(SharedRing());
  const LoopVerdict verdict =
      VerifyLoop(made.map, SharedRing().sensor(), made.last(), KeyframeId(5), true, 1, options_);
  ASSERT_TRUE(verdict.loop) << verdict.refusal;
  const auto found = static_cast<int>(verdict.loop->landmarks.size());
  options_.min_landmarks = found;
  EXPECT_TRUE(Closes({}));
  options_.min_landmarks = found + 1;
  EXPECT_FALSE(Closes({}));
  EXPECT_TRUE(Closes(ThreeThings())) << "half as many are enough if objects agree";
  options_.min_landmarks = 2 * found + 2;
  EXPECT_FALSE(Closes(ThreeThings()));

  options_.min_supporters = 100;  // there are never so many
  options_.min_landmarks = found / 2;
  EXPECT_TRUE(Closes({})) << "twice as many are needed without supporters";
  options_.min_landmarks = found / 2 + 1;
  EXPECT_FALSE(Closes({}));
}

TEST_F(LoopCloserTest, LeavesTheMapAloneForAWhileAfterALoop) {
  RingMap made = MakeRingMap(SharedRing(), {.keyframes = 40});
  const auto query = [&](uint32_t keyframe) {
    return LoopQuery{made.map.Snapshot(), KeyframeId(keyframe)};
  };
  LoopCloser closer = Make();
  EXPECT_TRUE(closer.Process(query(28)));
  EXPECT_FALSE(closer.Process(query(29)));
  EXPECT_FALSE(closer.Process(query(37)));
  EXPECT_TRUE(Make().Process(query(37))) << "it would be a loop if there had been none";
  EXPECT_TRUE(closer.Process(query(38)));
}

// The mapper drops a correction if the map was corrected since the snapshot.
TEST_F(LoopCloserTest, SeeksALoopAgainThatIsNotInTheCorrectedMap) {
  RingMap made = MakeRingMap(SharedRing(), {.keyframes = 40});
  const auto query = [](Map& map, uint32_t keyframe) {
    return LoopQuery{map.Snapshot(), KeyframeId(keyframe)};
  };
  LoopCloser closer = Make();
  const std::optional<MapCorrection> loop = closer.Process(query(made.map, 28));
  ASSERT_TRUE(loop);
  EXPECT_FALSE(closer.Process(query(made.map, 29))) << "the mapper has not processed it yet";
  Map closed = Corrected(made, *loop);
  Map dropped = made.map.Snapshot();
  dropped.CountCorrection();
  LoopCloser other = closer;
  EXPECT_FALSE(other.Process(query(closed, 30))) << "it is in the map";
  EXPECT_FALSE(other.Process(query(closed, 37)));
  EXPECT_TRUE(closer.Process(query(dropped, 30)));
  EXPECT_FALSE(closer.Process(query(dropped, 31)));
}

// Tracking has found 100 landmarks of the earlier visit, so the place is not a candidate any more.
// All other landmarks of the place are still in the map twice.
TEST_F(LoopCloserTest, MergesAPlaceToWhichTrackingHasLedBack) {
  RingMap made =
      MakeRingMap(SharedRing(), {.keyframes = 58, .keyframes_per_turn = 48, .drift = Rigid3()});
  const std::vector<uint32_t>& before = made.views[9].points;
  size_t found = 0;
  for (size_t i = 0; i < made.views[57].points.size() && found < 100; ++i) {
    const auto seen_at = std::find(before.begin(), before.end(), made.views[57].points[i]);
    const LandmarkId own = made.map.keyframes().At(made.last()).landmarks[i];
    if (seen_at != before.end() && own.IsValid()) {
      const auto keypoint = static_cast<size_t>(seen_at - before.begin());
      if (const LandmarkId old = made.map.keyframes().At(KeyframeId(9)).landmarks[keypoint];
          old.IsValid()) {
        made.map.ReplaceLandmark(own, old);
        ++found;
      }
    }
  }
  for (uint32_t i = 0; i < 58; ++i) {
    UpdateCovisibility(made.map, KeyframeId(i));
  }
  ASSERT_EQ(found, 100u);
  LoopCloser closer = Make();
  const std::optional<MapCorrection> correction =
      closer.Process({made.map.Snapshot(), made.last()});
  ASSERT_TRUE(correction);
  EXPECT_TRUE(correction->poses.empty());
  EXPECT_GT(correction->landmarks.size(), 100u);
  EXPECT_FALSE(closer.Process({made.map.Snapshot(), made.last()})) << "it is too soon";
  options_.enabled = false;
  EXPECT_FALSE(Close(made));
}

TEST_F(LoopCloserTest, TheSameMapGivesTheSameBits) {
  RingMap made = MakeRingMap(SharedRing(), {}, ThreeThings());
  const auto dump = [&] { return Dump(Corrected(made, Close(made).value())); };
  EXPECT_EQ(dump(), dump());
}

// The ring world of a monocular camera.
const RingWorld& MonocularRing() {
  static const RingWorld world({.points = 300, .pixel_noise = 0.2, .depth_share = 0.0});
  return world;
}

// A ring map without drift in which tracking was lost on the way. Its second part has another world
// frame and another unit of length.
class IslandJoin : public LoopCloserTest {
 protected:
  IslandJoin() {
    sensor_.kind = SensorKind::kMonocular;
    SplitRing(made_, 15, island_from_world_);
  }
  std::optional<MapCorrection> Join() {
    return LoopCloser(sensor_, options_, objects_, 1).Process({made_.map.Snapshot(), made_.last()});
  }

  Sensor sensor_ = SharedRing().sensor();
  // The motion is so large that no drift budget allows it.
  const Sim3 island_from_world_{2.5, ExpSo3({0.3, -0.4, 0.2}), {30.0, -10.0, 5.0}};
  RingMap made_ = MakeRingMap(MonocularRing(), {.drift = Rigid3()}, ThreeThings());
};

TEST_F(IslandJoin, GivesTheYoungerIslandThePoseAndTheScaleOfTheOlderOne) {
  ASSERT_EQ(FindViolations(made_.map), std::vector<std::string>());
  const std::optional<MapCorrection> correction = Join();
  ASSERT_TRUE(correction);
  const Map map = Corrected(made_, *correction);
  EXPECT_EQ(FindViolations(map), std::vector<std::string>());
  EXPECT_EQ(Islands(map), std::vector<IslandId>{IslandId(0)});
  EXPECT_EQ(map.islands_joined(), 1u);
  EXPECT_NEAR(map.ScaleOf(made_.last()), 1.0, 0.01);
  for (uint32_t i = 0; i < 30; ++i) {
    EXPECT_LT(PoseError(made_, map, KeyframeId(i)), i < 15 ? 1e-12 : 0.02) << i;
  }
  EXPECT_LT(map.landmarks().size(), made_.map.landmarks().size() - 150);
  EXPECT_EQ(map.objects().size(), 3u);
  EXPECT_EQ(map.keyframes().At(made_.last()).loops.size(), 1u);
}

// Two rooms that look the same, 5 m apart, in maps of other units of length.
TEST_F(IslandJoin, TheDriftBudgetDoesNotDependOnTheUnitOfLength) {
  for (const double unit : {0.01, 1.0, 100.0}) {
    for (const double drift : {0.0, 5.0}) {
      RingMap made = MakeRingMap(
          MonocularRing(), {.drift = Rigid3(Eigen::Quaterniond::Identity(), {drift, 0.0, 0.0})});
      ApplyCorrection(made.map, ScalingOf(made.map, unit), sensor_.levels);
      LoopCloser closer(sensor_, options_, objects_, 1);
      EXPECT_EQ(closer.Process({made.map.Snapshot(), made.last()}).has_value(), drift == 0.0)
          << "unit " << unit << ", drift " << drift;
    }
  }
}

// At the last keyframe no loop within an island would be sought so soon after another one.
TEST_F(IslandJoin, IsSoughtAlsoSoonAfterALoop) {
  RingMap one = MakeRingMap(SharedRing());
  one.map.CountCorrection();  // as in the other map, so that the loop is not taken for dropped
  LoopCloser closer(sensor_, options_, objects_, 1);
  ASSERT_TRUE(closer.Process({one.map.Snapshot(), KeyframeId(28)}));
  EXPECT_FALSE(closer.Process({one.map.Snapshot(), made_.last()}));
  EXPECT_TRUE(closer.Process({made_.map.Snapshot(), made_.last()}));
}

// Without this condition, a thing that looks the same at two places would be enough.
TEST_F(IslandJoin, NeedsASecondKeyframeThatShowsThePlace) {
  const std::vector<Covisible> neighbours = made_.map.keyframes().At(made_.last()).covisible;
  ASSERT_TRUE(Join());
  options_.min_supporters = 0;
  for (const Covisible& neighbour : neighbours) {
    made_.map.SetPose(neighbour.keyframe, Rigid3(ExpSo3({0.0, 3.0, 0.0}), {0.0, 0.0, 0.0}) *
                                              made_.map.CamFromWorld(neighbour.keyframe));
  }
  EXPECT_FALSE(Join()) << "they look elsewhere";
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_verification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "map/correction.h"
#include "map/keyframe_graph.h"
#include "places/similar_places.h"
#include "support/made_similarity.h"
#include "support/random_geometry.h"
#include "support/ring_world.h"

namespace hullslam {
namespace {

// Keyframe 29 is at the place of keyframe 5.
class LoopVerification : public testing::Test {
 protected:
  LoopVerdict Verify(const RingMap& made, uint32_t query = 29, uint32_t candidate = 5,
                     uint64_t seed = 1) const {
    return VerifyLoop(made.map, world_.sensor(), KeyframeId(query), KeyframeId(candidate), true,
                      seed, options_);
  }
  static Sim3 Truth(const RingMap& made, uint32_t query, uint32_t candidate) {
    return Sim3(made.true_cam_from_world[query] * Inverse(made.true_cam_from_world[candidate]));
  }

  const RingWorld& world_ = SharedRing();
  RingMap made_ = MakeRingMap(world_);
  LoopOptions options_;
};

TEST_F(LoopVerification, FindsTheTrueMotionBetweenTheEnds) {
  // The motion is also found if the viewing directions differ by 15 degrees.
  for (const uint32_t candidate : {4u, 5u, 6u}) {
    const LoopVerdict verdict = Verify(made_, 29, candidate);
    ASSERT_TRUE(verdict.loop) << candidate << ": " << verdict.refusal;
    EXPECT_EQ(verdict.refusal, "");
    EXPECT_EQ(verdict.loop->query, KeyframeId(29));
    EXPECT_EQ(verdict.loop->candidate, KeyframeId(candidate));
    EXPECT_EQ(verdict.loop->query_from_candidate.scale, 1.0);
    EXPECT_LT(Distance(verdict.loop->query_from_candidate, Truth(made_, 29, candidate)), 0.01);
  }
}

// The measured motion between two images does not depend on the poses that tracking gave them.
TEST_F(LoopVerification, DoesNotDependOnTheDrift) {
  const LoopVerdict a = Verify(made_);
  const LoopVerdict b =
      Verify(MakeRingMap(world_, {.drift = Rigid3(ExpSo3({0.1, 0.5, 0.3}), {2.0, -1.0, 3.0})}));
  ASSERT_TRUE(a.loop && b.loop);
  EXPECT_LT(Distance(a.loop->query_from_candidate, b.loop->query_from_candidate), 1e-6);
  EXPECT_EQ(a.loop->landmarks.size(), b.loop->landmarks.size());
}

TEST_F(LoopVerification, ItsLandmarksAreThoseAroundTheCandidateThatTheQueryShows) {
  const LoopVerdict verdict = Verify(made_);
  ASSERT_TRUE(verdict.loop) << verdict.refusal;
  const std::vector<LandmarkId> around =
      ObservedLandmarks(made_.map, PlaceOf(made_.map, KeyframeId(5)));
  for (const auto& [keypoint, landmark] : verdict.loop->landmarks) {
    EXPECT_TRUE(std::binary_search(around.begin(), around.end(), landmark));
    const Observation& seen = made_.map.landmarks().At(landmark).observations.front();
    EXPECT_EQ(made_.views[seen.keyframe.value].points[seen.keypoint],
              made_.views[29].points[keypoint]);
  }
  EXPECT_GT(verdict.loop->landmarks.size(), 100u);
  EXPECT_LT(ObservedLandmarks(made_.map, std::vector{KeyframeId(5)}).size(), around.size());
}

TEST_F(LoopVerification, AnotherPlaceIsRefusedWithAReason) {
  for (const uint32_t candidate : {0u, 11u, 17u}) {
    const LoopVerdict verdict = Verify(made_, 29, candidate);
    EXPECT_FALSE(verdict.loop) << candidate;
    EXPECT_NE(verdict.refusal, "");
  }
}

TEST_F(LoopVerification, RefusesIfFewerLandmarksAgreeThanAsked) {
  const LoopVerdict verdict = Verify(made_);
  ASSERT_TRUE(verdict.loop);
  options_.min_matches = static_cast<int>(verdict.loop->landmarks.size()) + 1;
  const LoopVerdict refused = Verify(made_);
  EXPECT_FALSE(refused.loop);
  EXPECT_NE(refused.refusal.find("expected at least " + std::to_string(options_.min_matches)),
            std::string::npos)
      << refused.refusal;
}

// Landmarks of the query that the map lacks cannot agree with anything.
TEST_F(LoopVerification, AQueryWithoutLandmarksIsRefused) {
  const std::vector<LandmarkId> landmarks = made_.map.keyframes().At(KeyframeId(29)).landmarks;
  for (const LandmarkId id : landmarks) {
    if (id.IsValid()) {
      made_.map.EraseLandmark(id);
    }
  }
  EXPECT_FALSE(Verify(made_).loop);
}

TEST_F(LoopVerification, TheSameInputGivesTheSameBits) {
  const LoopVerdict a = Verify(made_);
  const LoopVerdict b = Verify(made_);
  ASSERT_TRUE(a.loop && b.loop);
  EXPECT_EQ(a.loop->query_from_candidate.rotation.coeffs(),
            b.loop->query_from_candidate.rotation.coeffs());
  EXPECT_EQ(a.loop->query_from_candidate.translation, b.loop->query_from_candidate.translation);
  ASSERT_EQ(a.loop->landmarks.size(), b.loop->landmarks.size());
  for (size_t i = 0; i < a.loop->landmarks.size(); ++i) {
    EXPECT_EQ(a.loop->landmarks[i].keypoint, b.loop->landmarks[i].keypoint);
    EXPECT_EQ(a.loop->landmarks[i].landmark, b.loop->landmarks[i].landmark);
  }
}

constexpr double kPi = std::numbers::pi;

class TravelTest : public testing::Test {
 protected:
  Travel Between(uint32_t first, uint32_t last) const {
    return TravelBetween(made_.map, KeyframeId(first), KeyframeId(last));
  }
  RingMap made_ = MakeRingMap(SharedRing(), {.drift = Rigid3()});
};

TEST_F(TravelTest, IsTheLengthAndTurnOfThePathAndNotOfTheShortCut) {
  const Travel turn = Between(0, 24);
  EXPECT_NEAR(turn.radians, 2.0 * kPi, 1e-9);
  EXPECT_NEAR(turn.length, 24 * 2.0 * RingWorld::kRadius * std::sin(kPi / 24), 1e-9);
  const Travel none = Between(7, 7);
  EXPECT_EQ(none.length, 0.0);
  EXPECT_EQ(none.radians, 0.0);
}

// In a building that it patrols for hours, a camera would otherwise seem to drift by any amount.
TEST_F(TravelTest, IsShorterOverAClosedLoop) {
  const Travel before = Between(3, 20);
  made_.map.AddLoop(KeyframeId(0), KeyframeId(24));
  EXPECT_NEAR(Between(3, 20).length, before.length * 7.0 / 17.0, 1e-9);
  EXPECT_NEAR(Between(3, 20).radians, before.radians * 7.0 / 17.0, 1e-9);
  EXPECT_NEAR(Between(20, 3).length, before.length * 7.0 / 17.0, 1e-9);
}

TEST_F(TravelTest, AddsUpAndDoesNotDependOnTheDirection) {
  EXPECT_NEAR(Between(3, 9).length + Between(9, 20).length, Between(3, 20).length, 1e-12);
  EXPECT_NEAR(Between(3, 9).radians + Between(9, 20).radians, Between(3, 20).radians, 1e-12);
  EXPECT_EQ(Between(20, 3).length, Between(3, 20).length);
  EXPECT_EQ(Between(20, 3).radians, Between(3, 20).radians);
}

TEST_F(TravelTest, GoesAlongCulledKeyframesToo) {
  const Travel before = Between(3, 20);
  for (const uint32_t i : {5u, 6u, 12u}) {
    made_.map.CullKeyframe(KeyframeId(i));
  }
  EXPECT_NEAR(Between(3, 20).length, before.length, 1e-12);
  EXPECT_NEAR(Between(3, 20).radians, before.radians, 1e-12);
}

TEST_F(TravelTest, SkipsOtherIslands) {
  const Travel before = Between(3, 20);
  const IslandId island = made_.map.BeginIsland();
  for (const uint32_t i : {8u, 9u}) {
    made_.map.MoveToIsland(KeyframeId(i), island);
    made_.map.SetPose(KeyframeId(i), Rigid3(Eigen::Quaterniond::Identity(), {50.0, 0.0, 0.0}));
  }
  EXPECT_NEAR(Between(3, 20).radians, before.radians, 1e-9);
  EXPECT_LT(Between(3, 20).length, before.length);
  EXPECT_GT(Between(3, 20).length, 0.95 * before.length) << "only the short cut is shorter";
}

Rigid3 Moved(double metres) { return {Eigen::Quaterniond::Identity(), {metres, 0.0, 0.0}}; }
Rigid3 Turned(double radians) { return {ExpSo3({0.0, radians, 0.0}), Eigen::Vector3d::Zero()}; }

// Each option allows exactly the drift that it gives.
TEST(DriftBudget, GrowsWithTheTravel) {
  const LoopOptions none{.drift_base = 0.0,
                         .drift_per_metre = 0.0,
                         .drift_per_radian = 0.0,
                         .turn_base = 0.0,
                         .turn_per_metre = 0.0,
                         .turn_per_radian = 0.0};
  const Travel travel{.length = 20.0, .radians = 5.0};
  EXPECT_TRUE(CanBeDrift(travel, Rigid3(), Rigid3(), 1.0, none));
  EXPECT_FALSE(CanBeDrift(travel, Rigid3(), Moved(0.001), 1.0, none));
  EXPECT_FALSE(CanBeDrift(travel, Rigid3(), Turned(0.001), 1.0, none));
  struct Case {
    double LoopOptions::*option;
    double value;
    Rigid3 (*change)(double);
    double allowed;
  };
  for (const Case& one : {Case{&LoopOptions::drift_base, 0.3, &Moved, 0.3},
                          Case{&LoopOptions::drift_per_metre, 0.01, &Moved, 0.2},
                          Case{&LoopOptions::drift_per_radian, 0.1, &Moved, 0.5},
                          Case{&LoopOptions::turn_base, 0.3, &Turned, 0.3},
                          Case{&LoopOptions::turn_per_metre, 0.01, &Turned, 0.2},
                          Case{&LoopOptions::turn_per_radian, 0.1, &Turned, 0.5}}) {
    LoopOptions options = none;
    options.*one.option = one.value;
    EXPECT_TRUE(CanBeDrift(travel, Rigid3(), one.change(0.99 * one.allowed), 1.0, options));
    EXPECT_FALSE(CanBeDrift(travel, Rigid3(), one.change(1.01 * one.allowed), 1.0, options));
  }
}

// All lengths in a map may be larger by the same factor.
TEST(DriftBudget, DoesNotDependOnTheUnitOfLength) {
  RandomGeometry random(2);
  const Travel travel{.length = 4.0, .radians = 3.0};
  const Travel large{.length = 400.0, .radians = 3.0};
  int allowed = 0;
  for (int i = 0; i < 200; ++i) {
    Rigid3 tracked = random.Pose(3.0, 2.0);
    Rigid3 corrected = random.Pose(0.3, 0.4) * tracked;
    const bool can_be = CanBeDrift(travel, tracked, corrected, 1.0, {});
    tracked.translation *= 100.0;
    corrected.translation *= 100.0;
    EXPECT_EQ(CanBeDrift(large, tracked, corrected, 100.0, {}), can_be);
    allowed += can_be ? 1 : 0;
  }
  EXPECT_GT(allowed, 20);
  EXPECT_LT(allowed, 180);
}

TEST(DriftBudget, WithoutDepthTheDepthOfTheSceneIsTheMetre) {
  RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()});
  Sensor sensor = SharedRing().sensor();
  EXPECT_EQ(MetreOf(made.map, KeyframeId(3), sensor), 1.0);
  sensor.kind = SensorKind::kMonocular;
  const double depth = MetreOf(made.map, KeyframeId(3), sensor);
  EXPECT_GT(depth, 0.5);
  ApplyCorrection(made.map, ScalingOf(made.map, 50.0), sensor.levels);
  EXPECT_NEAR(MetreOf(made.map, KeyframeId(3), sensor), 50.0 * depth, 1e-6);
  const Map before = made.map.Snapshot();
  for (const auto& [id, landmark] : before.landmarks()) {
    made.map.EraseLandmark(id);
  }
  EXPECT_EQ(MetreOf(made.map, KeyframeId(3), sensor), 1.0) << "nothing is known";
}

// The distance is that of the camera's centres, wherever the origin of the world is.
TEST(DriftBudget, DoesNotDependOnTheWorldFrame) {
  RandomGeometry random(1);
  const Travel travel{.length = 10.0, .radians = 10.0};
  int allowed = 0;
  for (int i = 0; i < 200; ++i) {
    const Rigid3 tracked = random.Pose(3.0, 2.0);
    const Rigid3 corrected = random.Pose(0.5, 0.8) * tracked;
    const Rigid3 other_world = random.Pose(3.0, 100.0);
    const bool can_be = CanBeDrift(travel, tracked, corrected, 1.0, {});
    EXPECT_EQ(CanBeDrift(travel, tracked * other_world, corrected * other_world, 1.0, {}), can_be);
    EXPECT_EQ(CanBeDrift(travel, corrected, tracked, 1.0, {}), can_be) << "it is symmetric";
    allowed += can_be ? 1 : 0;
  }
  EXPECT_GT(allowed, 20);
  EXPECT_LT(allowed, 180);
}

}  // namespace
}  // namespace hullslam

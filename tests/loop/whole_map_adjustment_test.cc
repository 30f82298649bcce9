// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/whole_map_adjustment.h"

#include <gtest/gtest.h>

#include "loop/ring_islands.h"
#include "loop/ring_things.h"
#include "map/correction.h"
#include "map/invariants.h"
#include "map/made_map.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

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

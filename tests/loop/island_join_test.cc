// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/island_join.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "loop/ring_islands.h"
#include "map/correction.h"
#include "map/islands.h"
#include "map/made_map.h"
#include "map_files/invariants.h"
#include "support/ring_world.h"

namespace hullslam {
namespace {

// A ring of 30 keyframes; the last ones, which see what the first ones saw, are an island.
class WideIslandJoin : public testing::Test {
 protected:
  RingMap Split(uint32_t first, const FrameDecoration& decorate = {}) const {
    RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()}, decorate);
    SplitRing(made, first, Sim3(Rigid3(ExpSo3({0.3, 1.0, 0.2}), {1.0, -2.0, 0.5})));
    return made;
  }
  std::optional<MapCorrection> Find(RingMap& made, uint32_t query) const {
    return FindJoin(made.map, KeyframeId(query), SharedRing().sensor(), options_, {}, 1);
  }

  LoopOptions options_;
};

TEST_F(WideIslandJoin, MovesTheIslandToItsPlace) {
  RingMap made = Split(20);
  const std::optional<MapCorrection> join = Find(made, 29);
  ASSERT_TRUE(join);
  ASSERT_TRUE(ApplyCorrection(made.map, *join, SharedRing().sensor().levels).is_applied);
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  EXPECT_EQ(Islands(made.map).size(), 1u);
  for (uint32_t i = 20; i < 30; ++i) {
    EXPECT_LT(PoseError(made, made.map, KeyframeId(i)), 0.05) << i;
  }
}

// Where few landmarks agree, the scale of a part without depth may be wrong. With depth fewer are
// enough if the frames of both ends are near in time, as here those of keyframes 5 and 29.
TEST_F(WideIslandJoin, WithoutDepthThreeTimesAsManyLandmarksAreNeeded) {
  Sensor monocular = SharedRing().sensor();
  monocular.kind = SensorKind::kMonocular;
  RingMap made = Split(20, [](Frame& frame, const Rigid3&) {
    frame.id = FrameId(frame.id.value < 60 ? frame.id.value : frame.id.value - 71);
  });
  const auto joins = [&](const Sensor& sensor, int least) {
    options_.min_landmarks = least;
    return FindJoin(made.map, KeyframeId(29), sensor, options_, {}, 1).has_value();
  };
  int most = 12;  // about the largest bound with which a camera with depth joins the parts
  while (joins(SharedRing().sensor(), most + 12)) {
    most += 12;
  }
  EXPECT_TRUE(joins(monocular, most / 4));
  EXPECT_FALSE(joins(monocular, most / 2));
}

TEST_F(WideIslandJoin, OfAPlaceThatTheOthersHaveNotSeenThereIsNone) {
  RingMap apart = MakeRingMap(SharedRing(), {.keyframes = 18, .drift = Rigid3()});
  SplitRing(apart, 9, Sim3());
  EXPECT_FALSE(Find(apart, 15));
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/island_join.h"

#include <gtest/gtest.h>

#include <string>

#include "loop/ring_islands.h"
#include "map/correction.h"
#include "map/invariants.h"
#include "map/islands.h"
#include "map/made_map.h"
#include "support/ring_world.h"

namespace hullslam {
namespace {

// A ring of 30 keyframes; the last ones, which see what the first ones saw, are an island.
class WideIslandJoin : public testing::Test {
 protected:
  RingMap Split(uint32_t first) const {
    RingMap made = MakeRingMap(SharedRing(), {.drift = Rigid3()});
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

TEST_F(WideIslandJoin, OfAPlaceThatTheOthersHaveNotSeenThereIsNone) {
  RingMap apart = MakeRingMap(SharedRing(), {.keyframes = 18, .drift = Rigid3()});
  SplitRing(apart, 9, Sim3());
  EXPECT_FALSE(Find(apart, 15));
}

}  // namespace
}  // namespace hullslam

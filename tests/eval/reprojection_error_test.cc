// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/reprojection_error.h"

#include <gtest/gtest.h>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

TEST(MedianReprojectionError, IsZeroInAPerfectMap) {
  const SyntheticWorld world;
  const SyntheticMap made = MakeSyntheticMap(world, {0, 10, 20});
  const auto error = MedianReprojectionError(made.map, world.sensor().camera);
  ASSERT_TRUE(error);
  EXPECT_LT(*error, 1e-4);
}

// With another principal point all projections move by 3 px.
TEST(MedianReprojectionError, ShowsAWrongCamera) {
  const SyntheticWorld world;
  const SyntheticMap made = MakeSyntheticMap(world, {0, 10, 20});
  PinholeCamera shifted = world.sensor().camera;
  shifted.cx += 3.0;
  EXPECT_NEAR(*MedianReprojectionError(made.map, shifted), 3.0, 1e-4);
}

TEST(MedianReprojectionError, LeavesOutPointsBehindTheCamera) {
  const SyntheticWorld world;
  SyntheticMap made = MakeSyntheticMap(world, {0, 10});
  for (const LandmarkId id : made.landmarks) {
    if (id.IsValid()) {
      made.map.SetPosition(id, {0.0, 0.0, -5.0});
    }
  }
  EXPECT_FALSE(MedianReprojectionError(made.map, world.sensor().camera));
}

TEST(MedianReprojectionError, IsAbsentWithoutAMap) {
  EXPECT_FALSE(MedianReprojectionError(Map(), SyntheticSensor().camera));
}

TEST(MedianReprojectionError, ALandmarkWithOneObservationTellsNothing) {
  const SyntheticWorld world;
  PinholeCamera shifted = world.sensor().camera;
  shifted.cy += 2.0;
  EXPECT_NEAR(*MedianReprojectionError(MakeSyntheticMap(world, {0, 10}).map, shifted), 2.0, 1e-4);
  EXPECT_FALSE(MedianReprojectionError(MakeSyntheticMap(world, {0}).map, shifted));
}

}  // namespace
}  // namespace hullslam

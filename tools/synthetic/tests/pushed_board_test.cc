// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/pushed_board.h"

#include <gtest/gtest.h>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

TEST(MakePushedBoard, HasTheSizeOfABoardAndNoClass) {
  const SceneObject board = MakePushedBoard({}, {}).Build(Vector3d::Zero(), 0.0);
  EXPECT_FALSE(board.HasClass());
  EXPECT_NEAR(2.0 * board.half_extents.x(), 0.25, 1e-6);
  EXPECT_NEAR(2.0 * board.half_extents.z(), 0.2, 0.01);
}

TEST(PushedPath, RestsAtEachPlaceAndStaysAtTheLast) {
  const PushedPath path{.places = {{0.0, 0.0, 1.0}, {0.3, 0.0, 1.0}, {0.3, 0.2, 1.0}}};
  for (size_t i = 0; i < path.places.size(); ++i) {
    const double begin = static_cast<double>(i) * (path.rest + path.move);
    EXPECT_TRUE(path.WorldFromThing(begin).translation.isApprox(path.places[i]));
    EXPECT_TRUE(path.WorldFromThing(begin + path.rest).translation.isApprox(path.places[i]));
  }
  EXPECT_TRUE(path.WorldFromThing(1e9).translation.isApprox(path.places.back()));
  EXPECT_TRUE(path.WorldFromThing(path.rest + 0.5 * path.move)
                  .translation.isApprox(0.5 * (path.places[0] + path.places[1])));
  EXPECT_THROW(PushedPath().WorldFromThing(0.0), CheckError);
}

TEST(PushedPath, MovesWithoutJumps) {
  const PushedPath path{.places = {{0.0, 0.0, 1.0}, {0.3, 0.0, 1.0}}};
  for (double time = 0.0; time < 3.0; time += 1.0 / 30.0) {
    const Vector3d step =
        path.WorldFromThing(time + 1.0 / 30.0).translation - path.WorldFromThing(time).translation;
    EXPECT_LT(step.norm() * 30.0, 1.5 * 0.3 / path.move + 1e-9) << "metres per second at " << time;
  }
}

}  // namespace
}  // namespace hullslam::synthetic

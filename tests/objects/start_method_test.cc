// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/start_method.h"

#include <gtest/gtest.h>

#include "objects/initialisation.h"
#include "objects/seen_by_ring.h"

namespace hullslam {
namespace {

TEST(StartMethod, NamesAreInTheOrderOfTheEnumerators) {
  const std::vector<std::string> names = {"fitted", "oriented_box", "box_planes", "ray_sphere",
                                          "single_view"};
  EXPECT_EQ(ObjectStartNames(), names);
  EXPECT_EQ(&MethodOf(ObjectStart::kFitted), &StartFitted);
  EXPECT_EQ(&MethodOf(ObjectStart::kRaySphere), &StartByRays);
}

// Every method starts at an ellipsoid that every camera sees near the object.
TEST(StartMethod, AllFindAnObjectThatIsSeenFromAllSides) {
  const SeenByRing seen(MakeObject("cup", {0.0, 0.0, 0.1}, {0.12, 0.15, 0.18}), 12, 0.45);
  const std::vector<ResolvedObservation> observations = seen.Observations();
  const StartOptions options;
  for (size_t i = 0; i < ObjectStartNames().size(); ++i) {
    const std::vector<Ellipsoid> starts =
        MethodOf(static_cast<ObjectStart>(i))({.camera = seen.camera(),
                                               .observations = observations,
                                               .center = {0.0, 0.0, 0.1},
                                               .has_depth = true,
                                               .options = options});
    ASSERT_FALSE(starts.empty()) << ObjectStartNames()[i];
    for (const Ellipsoid& start : starts) {
      EXPECT_LT((start.world_from_object.translation - Eigen::Vector3d(0.0, 0.0, 0.1)).norm(), 0.25)
          << ObjectStartNames()[i];
      EXPECT_GT(start.half_axes.minCoeff(), 0.02) << ObjectStartNames()[i];
      EXPECT_LT(start.half_axes.maxCoeff(), 0.5) << ObjectStartNames()[i];
    }
  }
}

TEST(StartMethod, RaysDoNotUseDepth) {
  const SeenByRing seen(MakeObject("ball", {0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}), 4, 0.5);
  const std::vector<ResolvedObservation> observations = seen.Observations();
  const StartOptions options;
  const std::vector<Ellipsoid> starts = StartByRays({.camera = seen.camera(),
                                                     .observations = observations,
                                                     .center = {0.0, 0.0, 0.0},
                                                     .has_depth = true,
                                                     .options = options});
  ASSERT_EQ(starts.size(), 1u);
  EXPECT_EQ(starts[0].half_axes, StartFromRays(seen.camera(), observations, options)->half_axes);
}

}  // namespace
}  // namespace hullslam

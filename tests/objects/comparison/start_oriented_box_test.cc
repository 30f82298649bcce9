// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "objects/seen_by_ring.h"
#include "objects/start_method.h"

namespace hullslam {
namespace {

const MadeObject kBottle = MakeObject("bottle", {0.1, 0.0, 0.1}, {0.08, 0.12, 0.2}, 0.5);

TEST(StartByOrientedBox, IsInTheBoxOfTheDepthPoints) {
  const SeenByRing seen(kBottle, 8, 0.8);
  const std::vector<ResolvedObservation> observations = seen.Observations();
  const StartOptions options{.trimmed = 0.0, .inflation = 1.0};
  const std::vector<Ellipsoid> starts = StartByOrientedBox({.camera = seen.camera(),
                                                            .observations = observations,
                                                            .center = {0.1, 0.0, 0.1},
                                                            .has_depth = true,
                                                            .options = options});
  ASSERT_EQ(starts.size(), 1u);
  EXPECT_LT(
      (starts[0].world_from_object.translation - kBottle.ellipsoid.world_from_object.translation)
          .norm(),
      0.02);
  EXPECT_NEAR(starts[0].half_axes.maxCoeff(), 0.2, 0.03);
  EXPECT_NEAR(starts[0].half_axes.minCoeff(), 0.08, 0.03);
}

TEST(StartByOrientedBox, WithoutDepthTakesLandmarks) {
  const SeenByRing seen(kBottle, 4, 0.8);
  std::vector<ResolvedObservation> observations = seen.Observations();
  std::vector<Detection> detections;
  for (const ResolvedObservation& observation : observations) {
    detections.push_back(*observation.detection);
    detections.back().points.clear();
  }
  for (size_t i = 0; i < observations.size(); ++i) {
    observations[i].landmarks = observations[i].detection->points.Unpack();
    observations[i].detection = &detections[i];
  }
  const StartOptions options{.trimmed = 0.0, .inflation = 1.0};
  const StartInput input{.camera = seen.camera(),
                         .observations = observations,
                         .center = {0.1, 0.0, 0.1},
                         .options = options};
  ASSERT_EQ(StartByOrientedBox(input).size(), 1u);
  EXPECT_NEAR(StartByOrientedBox(input)[0].half_axes.maxCoeff(), 0.2, 0.03);
  // Two landmarks that all observations show are two, not eight.
  const std::vector<Eigen::Vector3d> two = {{0.1, 0.0, 0.1}, {0.2, 0.05, 0.15}};
  for (ResolvedObservation& observation : observations) {
    observation.landmarks = {observation.cam_from_world * two[0],
                             observation.cam_from_world * two[1]};
  }
  EXPECT_TRUE(StartByOrientedBox(input).empty());
}

}  // namespace
}  // namespace hullslam

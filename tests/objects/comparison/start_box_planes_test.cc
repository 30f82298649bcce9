// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "objects/seen_by_ring.h"
#include "objects/start_method.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

Eigen::Vector3d SortedAxes(Eigen::Vector3d axes) {
  std::sort(axes.begin(), axes.end());
  return axes;
}

TEST(EllipsoidOfDualQuadric, IsTheInverseOfTheDualQuadric) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    Ellipsoid ellipsoid;
    ellipsoid.world_from_object = random.Pose(2.0, 3.0);
    ellipsoid.half_axes = {random.Number(0.1, 0.3), random.Number(0.4, 0.6),
                           random.Number(0.7, 0.9)};
    const Eigen::Matrix4d quadric = random.Number(0.5, 3.0) * ellipsoid.DualQuadric();
    const std::optional<Ellipsoid> found = EllipsoidOfDualQuadric(quadric);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->DualQuadric().isApprox(ellipsoid.DualQuadric(), 1e-9));
    EXPECT_TRUE(EllipsoidOfDualQuadric(-quadric)->half_axes.isApprox(found->half_axes, 1e-9));
  }
}

TEST(EllipsoidOfDualQuadric, AHyperboloidTakesTheAbsoluteValues) {
  Eigen::Matrix4d quadric = Eigen::Vector4d(0.04, -0.09, 0.25, -1.0).asDiagonal();
  const std::optional<Ellipsoid> found = EllipsoidOfDualQuadric(quadric);
  ASSERT_TRUE(found);
  EXPECT_TRUE(SortedAxes(found->half_axes).isApprox(Eigen::Vector3d(0.2, 0.3, 0.5), 1e-9));
}

TEST(EllipsoidOfDualQuadric, AQuadricAtInfinityIsNoEllipsoid) {
  Eigen::Matrix4d quadric = Eigen::Matrix4d::Identity();
  quadric(3, 3) = 0.0;
  EXPECT_FALSE(EllipsoidOfDualQuadric(quadric));
}

TEST(StartByBoxPlanes, FindsAnEllipsoidOfExactBoxes) {
  const MadeObject object = MakeObject("cup", {0.1, -0.05, 0.1}, {0.1, 0.15, 0.25}, 0.4);
  const SeenByRing seen(object, 12, 0.45);
  const std::vector<ResolvedObservation> observations = seen.Observations();
  const StartOptions options;
  const std::vector<Ellipsoid> starts = StartByBoxPlanes({.camera = seen.camera(),
                                                          .observations = observations,
                                                          .center = {0.0, 0.0, 0.0},
                                                          .has_depth = true,
                                                          .options = options});
  ASSERT_EQ(starts.size(), 1u);
  EXPECT_LT(
      (starts[0].world_from_object.translation - object.ellipsoid.world_from_object.translation)
          .norm(),
      0.01);
  EXPECT_LT((SortedAxes(starts[0].half_axes) - object.ellipsoid.half_axes).cwiseAbs().maxCoeff(),
            0.02);
}

TEST(StartByBoxPlanes, NeedsThreeViews) {
  const SeenByRing seen(MakeObject("cup", {0.0, 0.0, 0.0}, {0.1, 0.15, 0.25}), 2, 0.5);
  const std::vector<ResolvedObservation> observations = seen.Observations();
  const StartOptions options;
  EXPECT_TRUE(StartByBoxPlanes({.camera = seen.camera(),
                                .observations = observations,
                                .center = {0.0, 0.0, 0.0},
                                .options = options})
                  .empty());
}

// The border of the image cuts off half of the box in some observations.
TEST(StartByBoxPlanes, LeavesOutCutBoxesIfThreeOthersRemain) {
  const MadeObject object = MakeObject("cup", {0.1, -0.05, 0.1}, {0.1, 0.15, 0.25}, 0.4);
  const SeenByRing seen(object, 12, 0.45);
  const StartOptions options;
  const auto largest_error = [&](size_t cut) {
    std::vector<ResolvedObservation> observations = seen.Observations();
    std::vector<Detection> detections;
    for (const ResolvedObservation& observation : observations) {
      detections.push_back(*observation.detection);
    }
    for (size_t i = 0; i < observations.size(); ++i) {
      if (i < cut) {
        detections[i].is_cut = true;
        detections[i].box.max().x() = detections[i].box.center().x();
      }
      observations[i].detection = &detections[i];
    }
    const std::vector<Ellipsoid> starts = StartByBoxPlanes({.camera = seen.camera(),
                                                            .observations = observations,
                                                            .center = {0.0, 0.0, 0.0},
                                                            .has_depth = true,
                                                            .options = options});
    return starts.empty() ? 1.0
                          : (SortedAxes(starts[0].half_axes) - object.ellipsoid.half_axes)
                                .cwiseAbs()
                                .maxCoeff();
  };
  EXPECT_LT(largest_error(4), 0.02);
  EXPECT_LT(largest_error(9), 0.02) << "three whole boxes are enough";
  EXPECT_GT(largest_error(10), 0.02) << "two are not, so the cut ones are used too";
}

}  // namespace
}  // namespace hullslam

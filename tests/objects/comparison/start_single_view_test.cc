// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "objects/seen_by_ring.h"
#include "objects/start_method.h"

namespace hullslam {
namespace {

StartInput InputOf(const SeenByRing& seen, std::span<const ResolvedObservation> views,
                   const StartOptions& options) {
  return {.camera = seen.camera(),
          .observations = views,
          .center = {0.0, 0.0, 0.0},
          .has_depth = true,
          .options = options};
}

TEST(StartBySingleView, FacesTheCameraWithTheSizeOfTheBox) {
  const SeenByRing seen(MakeObject("ball", {0.0, 0.0, 0.0}, {0.15, 0.15, 0.15}), 1, 0.3);
  const std::vector<ResolvedObservation> views = seen.Observations();
  const StartOptions options;
  const std::vector<Ellipsoid> starts = StartBySingleView(InputOf(seen, views, options));
  ASSERT_EQ(starts.size(), 1u);
  const Rigid3 cam_from_object = views[0].cam_from_world * starts[0].world_from_object;
  const Eigen::Vector3d forward = cam_from_object.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(forward.dot(cam_from_object.translation.normalized()), 1.0, 1e-9);
  // The centre is at the depth of the visible surface, so it is nearer than that of the ball.
  const double depth = cam_from_object.translation.z();
  EXPECT_LT(depth, views[0].cam_from_world.translation.norm());
  EXPECT_NEAR(starts[0].half_axes.x(), 0.15, 0.03);
  EXPECT_NEAR(starts[0].half_axes.y(), 0.15, 0.03);
  const auto ellipse = ProjectEllipsoid(seen.camera().Matrix(), views[0].cam_from_world, starts[0]);
  ASSERT_TRUE(ellipse);
  EXPECT_LT((ellipse->center - views[0].detection->box.center()).norm(), 2.0);
}

TEST(StartBySingleView, TheThicknessIsBounded) {
  const StartOptions options;
  const SeenByRing thick(MakeObject("ball", {0.0, 0.0, 0.0}, {0.6, 0.6, 0.6}), 1, 0.3);
  const std::vector<ResolvedObservation> of_thick = thick.Observations();
  EXPECT_EQ(StartBySingleView(InputOf(thick, of_thick, options)).at(0).half_axes.z(), 0.1);
  const SeenByRing thin(MakeObject("ball", {0.0, 0.0, 0.0}, {0.02, 0.02, 0.02}), 1, 0.3);
  const std::vector<ResolvedObservation> of_thin = thin.Observations();
  EXPECT_EQ(StartBySingleView(InputOf(thin, of_thin, options)).at(0).half_axes.z(), 0.025);
}

TEST(StartBySingleView, WithoutDepthTheRaysDecide) {
  const SeenByRing seen(MakeObject("ball", {0.0, 0.0, 0.0}, {0.15, 0.15, 0.15}), 4, 0.5);
  std::vector<ResolvedObservation> views = seen.Observations();
  std::vector<Detection> detections;
  for (const ResolvedObservation& view : views) {
    detections.push_back(*view.detection);
    detections.back().points.clear();
  }
  for (size_t i = 0; i < views.size(); ++i) {
    views[i].detection = &detections[i];
  }
  const StartOptions options;
  StartInput input = InputOf(seen, views, options);
  input.has_depth = false;
  ASSERT_EQ(StartBySingleView(input).size(), 1u);
  EXPECT_NEAR(StartBySingleView(input)[0].half_axes.x(), 0.15, 0.02);
}

// Depths of 1 m to 1.1 m in steps of 1 mm; those of 1.005 m to 1.095 m count.
TEST(StartBySingleView, TheThicknessIsThatOfNineTenthsOfTheDepths) {
  const SeenByRing seen(MakeObject("ball", {0.0, 0.0, 0.0}, {0.15, 0.15, 0.15}), 1, 0.3);
  std::vector<ResolvedObservation> views = seen.Observations();
  Detection detection = *views[0].detection;
  std::vector<Eigen::Vector3d> points;
  for (int i = 100; i >= 0; --i) {
    points.emplace_back(0.0, 0.0, 1.0 + 0.001 * i);
  }
  detection.points = points;
  views[0].detection = &detection;
  const StartOptions options;
  const Ellipsoid start = StartBySingleView(InputOf(seen, views, options)).at(0);
  EXPECT_NEAR(start.half_axes.z(), 0.045, 1e-3);
  EXPECT_NEAR((views[0].cam_from_world * start.world_from_object).translation.z(), 1.05, 1e-3);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/raw_residual.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "calibration/made_recording.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

const PointVelocity kStill;

TEST(RawResidual, HasTheValueThatIsComputedByHand) {
  CameraModel model;
  model.camera.fx = 500.0;
  model.camera.fy = 400.0;
  model.camera.cx = 320.0;
  model.camera.cy = 240.0;
  model.camera.bf = 40.0;
  model.disparity_offset = 0.5;
  model.depth_scale = 1.25;
  const RawResidual residual{.disparity_sigma = 0.5};
  const CalibrationObservation seen{
      .view = 0, .raw = {419.0, 282.0}, .sigma = 2.0, .disparity = 17.0};
  // Seen at (320 + 500 / 5, 240 + 400 / 10); disparity 40 / (1.25 * 2) + 0.5.
  const Eigen::Vector3d expected(0.5, -1.0, -1.0);
  EXPECT_LT((residual.At(model, kStill, seen, {0.4, 0.2, 2.0}) - expected).norm(), 1e-12);
  CalibrationObservation without = seen;
  without.disparity = 0.0;
  EXPECT_EQ(residual.At(model, kStill, without, {0.4, 0.2, 2.0}).z(), 0.0);
  EXPECT_TRUE(std::isinf(residual.At(model, kStill, seen, {0.4, 0.2, -2.0}).x()));
}

// The point is at (0.4, 0.2, 2) with the image, and at (0.5, 0.2, 2.5) 0.1 s later, when its depth
// is measured from 0.5 m farther back; its surface has a disparity there that changes by 0.02 px
// per px.
TEST(RawResidual, DepthIsThatOfItsOwnTimeAndPlace) {
  CameraModel model;
  model.camera.fx = model.camera.fy = 500.0;
  model.camera.bf = 40.0;
  model.depth_time = 0.06;
  model.depth_pose << 0.0, 0.0, 0.0, 0.0, 0.0, 0.7;
  RawResidual residual{.disparity_sigma = 0.5};
  residual.known_depth_pose << 0.0, 0.0, 0.0, 0.0, 0.0, 0.2;
  const CalibrationObservation seen{.view = 0,
                                    .raw = {100.0, 50.0},
                                    .disparity = 12.0,
                                    .slope = {0.02, 0.0},
                                    .depth_delay = 0.04};
  const PointVelocity velocity{.linear = {1.0, 0.0, 5.0}};
  // 40 / 3 + 0.02 (100 - 500 * 0.5 / 3)
  const double expected = 40.0 / 3.0 + 0.02 * (100.0 - 250.0 / 3.0);
  EXPECT_NEAR(residual.At(model, velocity, seen, {0.4, 0.2, 2.0}).z(), (expected - 12.0) / 0.5,
              1e-9);
}

TEST(RawResidual, TheDerivativeByThePointIsThatOfTheNumbers) {
  RandomGeometry random(1);
  const RawResidual residual{.disparity_sigma = 0.7};
  for (const CameraModel& model : MadeCameraModels()) {
    for (int i = 0; i < 20; ++i) {
      const PointVelocity velocity{.angular = random.Vector(1.0), .linear = random.Vector(1.0)};
      const Eigen::Vector3d point(random.Number(-0.8, 0.8), random.Number(-0.6, 0.6), 1.5);
      const CalibrationObservation seen{.view = 0,
                                        .raw = model.camera.Distort(model.camera.Project(point)),
                                        .sigma = 0.6,
                                        .disparity = 25.0,
                                        .slope = {0.1, -0.06},
                                        .depth_delay = 0.008};
      constexpr double kStep = 1e-6;
      Eigen::Matrix3d expected;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
        expected.col(k) = (residual.At(model, velocity, seen, point + step) -
                           residual.At(model, velocity, seen, point - step)) /
                          (2.0 * kStep);
      }
      const Eigen::Matrix3d derivative = residual.ByPoint(model, velocity, seen, point);
      EXPECT_LT((derivative - expected).norm(), 1e-5 * expected.norm());
    }
  }
}

// A step of a number moves the residual by its derivative, to first order.
TEST(ByCameraParameters, PredictsTheResidualsOfACameraNearBy) {
  RandomGeometry random(2);
  const RawResidual residual;
  for (const CameraModel& model : MadeCameraModels()) {
    const auto parameters = ParametersOf(model, {}, true, 300.0);
    const ByCameraParameters by_camera(model, parameters);
    const PointVelocity velocity{.angular = {0.3, 0.5, -0.2}, .linear = {0.1, 0.2, 0.1}};
    const Eigen::Vector3d point(0.5, -0.4, 1.3);
    const CalibrationObservation seen{.view = 0,
                                      .raw = model.camera.Distort(model.camera.Project(point)),
                                      .sigma = 1.0,
                                      .disparity = 25.0,
                                      .slope = {0.1, -0.06}};
    const auto derivative = by_camera.Of(residual, velocity, seen, point);
    const Eigen::Vector3d here = residual.At(model, velocity, seen, point);
    for (size_t i = 0; i < parameters.size(); ++i) {
      constexpr double kSteps = 0.05;
      CameraModel moved = model;
      parameters[i].Move(kSteps, moved);
      const Eigen::Vector3d expected = residual.At(moved, velocity, seen, point) - here;
      EXPECT_LT((kSteps * derivative.col(static_cast<Eigen::Index>(i)) - expected).norm(), 1e-3)
          << parameters[i].name;
    }
  }
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/camera_path.h"

#include <gtest/gtest.h>

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

TEST(LookAt, PutsTheTargetOnTheAxisAndKeepsTheImageUpright) {
  const Vector3d eye(1.0, -2.0, 1.5);
  const Vector3d target(0.2, 0.3, 0.7);
  const Rigid3 cam_from_world = Inverse(LookAt(eye, target));
  EXPECT_LT((cam_from_world * eye).norm(), 1e-12);
  EXPECT_LT((cam_from_world * target - Vector3d(0.0, 0.0, (target - eye).norm())).norm(), 1e-12);
  const Vector3d above = cam_from_world * (target + Vector3d(0.0, 0.0, 0.1));
  EXPECT_NEAR(above.x(), 0.0, 1e-12);
  EXPECT_LT(above.y(), 0.0);  // the y axis points down
}

TEST(OrbitPath, KeepsItsDistanceAndSpeed) {
  const OrbitPath orbit{.target = {0.0, 0.0, 0.8}};
  for (int i = 0; i < 200; ++i) {
    const double time = 0.1 * i;
    const Vector3d eye = orbit.WorldFromCam(time).translation;
    EXPECT_NEAR(eye.head<2>().norm(), orbit.radius, 0.09 * orbit.radius);
    const double speed = (orbit.WorldFromCam(time + 0.01).translation - eye).norm() / 0.01;
    EXPECT_GT(speed, 0.15);
    EXPECT_LT(speed, 0.4);
  }
}

TEST(LoopPath, ReturnsToTheStartAndGoesALittleFurther) {
  const LoopPath loop;
  double nearest = 10.0;
  for (int i = 800; i <= 1000; ++i) {
    const double time = 0.001 * i * loop.duration;
    const Rigid3 motion = Inverse(loop.WorldFromCam(0.0)) * loop.WorldFromCam(time);
    nearest = std::min(nearest, motion.translation.norm() + LogSo3(motion.rotation).norm());
  }
  EXPECT_LT(nearest, 0.01);
  EXPECT_GT(
      AngularDistance(loop.WorldFromCam(0.0).rotation, loop.WorldFromCam(loop.duration).rotation),
      0.1);
}

TEST(HandMotion, IsSmallSmoothAndSeeded) {
  const HandMotion hand(1);
  const HandMotion other(2);
  double difference = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double time = i / 30.0;
    const Rigid3 motion = hand.Apply({}, time);
    EXPECT_LT(motion.translation.norm(), 0.05);
    EXPECT_LT(LogSo3(motion.rotation).norm(), 0.05);
    const Rigid3 step = Inverse(motion) * hand.Apply({}, time + 1.0 / 30.0);
    EXPECT_LT(step.translation.norm(), 0.006);
    EXPECT_LT(LogSo3(step.rotation).norm(), 0.006);
    difference += (other.Apply({}, time).translation - motion.translation).norm();
  }
  EXPECT_GT(difference, 0.1);
}

}  // namespace
}  // namespace hullslam::synthetic

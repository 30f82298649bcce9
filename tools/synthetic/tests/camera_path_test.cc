// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hullslam/util/check.h"

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

// A path that walks 1 m in 2 s, turns by 90 degrees in 3 s, and takes 2.5 s for the last half
// metre, which is more time than it needs.
WaypointPath TestWalk() {
  return {{{.eye = {0.0, 0.0, 1.4}, .yaw = 0.0, .pitch = 0.0},
           {.eye = {1.0, 0.0, 1.4}, .yaw = 0.0, .pitch = -10.0},
           {.eye = {1.0, 0.5, 1.4}, .yaw = 90.0, .pitch = -10.0},
           {.eye = {1.0, 1.0, 1.3}, .yaw = 90.0, .pitch = 0.0, .seconds = 2.5}},
          0.5,
          30.0};
}

TEST(WaypointPath, PassesItsWaypointsInTimeAndRestsAtTheEnds) {
  const WaypointPath walk = TestWalk();
  EXPECT_NEAR(walk.duration(), 2.0 + 3.0 + 2.5, 1e-12);
  const auto expect = [&](double time, const Vector3d& eye, double yaw, double pitch) {
    const Rigid3 pose = walk.WorldFromCam(time);
    EXPECT_LT((pose.translation - eye).norm(), 1e-12) << time;
    const double y = yaw * std::numbers::pi / 180.0;
    const double p = pitch * std::numbers::pi / 180.0;
    const Vector3d forward(std::cos(p) * std::cos(y), std::cos(p) * std::sin(y), std::sin(p));
    EXPECT_LT((pose.rotation * Vector3d::UnitZ() - forward).norm(), 1e-12) << time;
  };
  expect(-1.0, {0.0, 0.0, 1.4}, 0.0, 0.0);
  expect(0.0, {0.0, 0.0, 1.4}, 0.0, 0.0);
  expect(2.0, {1.0, 0.0, 1.4}, 0.0, -10.0);
  expect(5.0, {1.0, 0.5, 1.4}, 90.0, -10.0);
  expect(7.5, {1.0, 1.0, 1.3}, 90.0, 0.0);
  expect(100.0, {1.0, 1.0, 1.3}, 90.0, 0.0);
}

TEST(WaypointPath, HasNoJumpsInPositionOrVelocity) {
  const WaypointPath walk = TestWalk();
  constexpr double kStep = 1e-4;
  const auto velocity = [&](double time) -> Vector3d {
    return (walk.WorldFromCam(time + kStep).translation - walk.WorldFromCam(time).translation) /
           kStep;
  };
  for (double time = -0.5; time < walk.duration() + 0.5; time += 0.01) {
    EXPECT_LT(velocity(time).norm(), 1.0) << time;
    EXPECT_LT((velocity(time + 0.01) - velocity(time)).norm(), 0.04) << time;
  }
}

TEST(WaypointPath, NeedsTwoDifferentWaypoints) {
  const Waypoint here{.eye = {0.0, 0.0, 1.4}};
  EXPECT_THROW(WaypointPath({here}, 0.5, 30.0), CheckError);
  EXPECT_THROW(WaypointPath({here, here}, 0.5, 30.0), CheckError);
}

TEST(SweepPath, GoesToAndFroAndLooksAtTheTable) {
  const SweepPath path{.target = {0.0, 0.0, 0.8}};
  const double period = 1.0 / path.frequency;
  const auto angle = [&](double time) {
    const Vector3d eye = path.WorldFromCam(time).translation;
    return std::atan2(eye.y(), eye.x());
  };
  EXPECT_NEAR(angle(0.25 * period), path.middle_angle + path.swing, 1e-9);
  EXPECT_NEAR(angle(0.75 * period), path.middle_angle - path.swing, 1e-9);
  for (double time = 0.0; time < period; time += 0.1) {
    const Vector3d seen = Inverse(path.WorldFromCam(time)) * path.target;
    EXPECT_GT(seen.z(), 0.9);
    EXPECT_LT(seen.head<2>().norm(), 0.2);
  }
}

TEST(PacedPath, IsTheSameWalkInAnotherTime) {
  const WaypointPath path({{{0.0, 0.0, 1.0}, 0.0, 0.0}, {{1.0, 0.0, 1.0}, 30.0, 0.0}}, 0.5, 20.0);
  const PacedPath slow(path, 3.0 * path.duration());
  for (const double time : {0.0, 0.4, 1.1}) {
    EXPECT_EQ(slow.WorldFromCam(3.0 * time).translation, path.WorldFromCam(time).translation);
  }
  EXPECT_THROW(PacedPath(path, 0.0), CheckError);
}

TEST(ByHand, AddsTheSameMotionToEachPath) {
  const OrbitPath orbit;
  const auto shaken = ByHand(orbit, 4);
  const auto again = ByHand([&](double time) { return orbit.WorldFromCam(time); }, 4);
  const auto other = ByHand(orbit, 5);
  EXPECT_EQ(shaken(1.5).translation, again(1.5).translation);
  EXPECT_NE(shaken(1.5).translation, other(1.5).translation);
  EXPECT_LT((shaken(1.5).translation - orbit.WorldFromCam(1.5).translation).norm(), 0.06);
}

}  // namespace
}  // namespace hullslam::synthetic

// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/box_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "scene/made_scene.h"
#include "scene/object_body.h"

namespace hullslam {
namespace {

using Support = std::function<double(const Eigen::Vector3d& normal)>;

// The planes that touch a thing, as cameras on a circle above it see them.
std::vector<SupportPlane> PlanesOf(const Support& support, double noise = 0.0,
                                   double least_height = -1.0) {
  std::mt19937 random(3);
  std::normal_distribution<double> error(0.0, noise);
  std::vector<SupportPlane> planes;
  constexpr int kCount = 600;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d normal = SphereDirection(i, kCount);
    if (normal.z() > least_height && std::abs(normal.z()) < 0.9) {
      planes.push_back({normal, support(normal) + error(random), 400.0});
    }
  }
  return planes;
}

Support SupportOfBox(const Rigid3& pose, const Eigen::Vector3d& half) {
  return [pose, half](const Eigen::Vector3d& normal) {
    return normal.dot(pose.translation) + (pose.rotation.conjugate() * normal).cwiseAbs().dot(half);
  };
}

Rigid3 Turned(double degrees, const Eigen::Vector3d& center) {
  const double angle = degrees * 3.14159265358979 / 180.0;
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())), center};
}

// What a fit of lines gives: larger than the thing inside its corners, and badly known in z.
Ellipsoid Around(const Rigid3& pose, const Eigen::Vector3d& half) {
  return {pose, Eigen::Vector3d(1.3 * half.x(), 1.2 * half.y(), 1.6 * half.z())};
}

TEST(FitBox, FindsABoxInAnyTurn) {
  const Eigen::Vector3d half(0.2, 0.12, 0.02);  // such as a book
  for (const double degrees : {0.0, 17.0, 44.0, 71.0}) {
    const Rigid3 pose = Turned(degrees, {1.0, 2.0, 0.5});
    const auto box = FitBox(PlanesOf(SupportOfBox(pose, half), 1e-3), Around(pose, half));
    ASSERT_TRUE(box) << degrees;
    EXPECT_LT((box->world_from_box.translation - pose.translation).norm(), 1e-3);
    EXPECT_NEAR(box->half_extents.head<2>().maxCoeff(), 0.2, 2e-3) << degrees;
    EXPECT_NEAR(box->half_extents.head<2>().minCoeff(), 0.12, 2e-3) << degrees;
    EXPECT_NEAR(box->half_extents.z(), 0.02, 2e-3) << degrees;
    const Eigen::Vector3d longest =
        box->world_from_box.rotation * (box->half_extents.x() > box->half_extents.y()
                                            ? Eigen::Vector3d::UnitX()
                                            : Eigen::Vector3d::UnitY());
    EXPECT_GT(std::abs(longest.dot(pose.rotation * Eigen::Vector3d::UnitX())), 0.9998) << degrees;
  }
}

// A quarter of the lines are those of something that hides it.
TEST(FitBox, WrongLinesHardlyCount) {
  const Eigen::Vector3d half(0.2, 0.12, 0.1);
  const Rigid3 pose = Turned(30.0, {0.0, 0.0, 0.0});
  std::vector<SupportPlane> planes = PlanesOf(SupportOfBox(pose, half), 1e-3);
  for (size_t i = 0; i < planes.size(); i += 4) {
    planes[i].support -= 0.08;
  }
  const auto box = FitBox(planes, Around(pose, half));
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->half_extents.head<2>().maxCoeff(), 0.2, 5e-3);
  EXPECT_NEAR(box->half_extents.z(), 0.1, 5e-3);
}

// Two slabs at a right angle: no box has this hull.
TEST(FitBox, IsAlmostAroundAThingThatIsNoBox) {
  const Support seat = SupportOfBox(Rigid3(), {0.25, 0.25, 0.03});
  const Support back = SupportOfBox(Turned(0.0, {0.0, 0.22, 0.25}), {0.25, 0.03, 0.25});
  const auto box = FitBox(
      PlanesOf([&](const Eigen::Vector3d& normal) { return std::max(seat(normal), back(normal)); }),
      {Turned(0.0, {0.0, 0.05, 0.2}), Eigen::Vector3d(0.3, 0.3, 0.3)});
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->half_extents.x(), 0.25, 0.03);
  EXPECT_NEAR(box->half_extents.y(), 0.25, 0.05);
  EXPECT_NEAR(box->half_extents.z(), 0.265, 0.06);
}

// As of an object that was seen three times, and once wrongly.
TEST(FitBox, LinesThatContradictOneAnotherGiveNoFlatBox) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> support(-0.2, 0.2);
  std::vector<SupportPlane> planes = PlanesOf([&](const auto&) { return support(random); });
  EXPECT_FALSE(FitBox(planes, {Rigid3(), Eigen::Vector3d(0.02, 0.02, 0.02)}));
}

TEST(FitBox, ARoundThingHasNone) {
  const Ellipsoid ball = {Turned(20.0, {0.3, 0.1, 0.2}), Eigen::Vector3d(0.1, 0.12, 0.08)};
  EXPECT_FALSE(
      FitBox(PlanesOf([&](const Eigen::Vector3d& normal) { return SupportOf(ball, normal); }, 1e-3),
             ball));
}

// Seen from above only, nothing tells how far down it reaches, so its ellipsoid does.
TEST(FitBox, WhatNoLineTellsIsThatOfTheEllipsoid) {
  const Eigen::Vector3d half(0.2, 0.12, 0.1);
  std::vector<SupportPlane> planes = PlanesOf(SupportOfBox(Rigid3(), half), 1e-3, 0.2);
  const auto box = FitBox(planes, {Rigid3(), Eigen::Vector3d(0.25, 0.15, 0.12)});
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->half_extents.z(), 0.12, 0.03);
  EXPECT_NEAR(box->world_from_box.translation.z() + box->half_extents.z(), 0.1, 5e-3);
  planes.resize(20);
  EXPECT_FALSE(FitBox(planes, Around(Rigid3(), half))) << "too few";
}

// Two views touch +x and +z of the turned box, one view touches -y, and none touches the others.
TEST(FindSeenSides, NeedsLinesOfTwoViews) {
  const Rigid3 pose = Turned(40.0, {0.1, 0.2, 0.3});
  const Eigen::Quaterniond frame(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  UprightBox box{pose, Eigen::Vector3d(0.2, 0.1, 0.1)};
  const auto plane = [&](const Eigen::Vector3d& in_box, size_t view) {
    return SupportPlane{
        .normal = frame * (pose.rotation * in_box.normalized()), .support = 0.0, .view = view};
  };
  const std::vector<SupportPlane> planes = {plane({1.0, 0.5, 0.0}, 0),  plane({1.0, -0.4, 0.3}, 3),
                                            plane({0.2, 0.0, 1.0}, 1),  plane({0.0, -0.3, 1.0}, 2),
                                            plane({0.0, -1.0, 0.1}, 2), plane({0.1, -1.0, 0.0}, 2)};
  FindSeenSides(planes, frame, box);
  EXPECT_EQ(box.is_seen, (std::array{false, true, false, false, false, true}));
}

TEST(SupportPlanesOf, AreThoseOfTheLinesThatNothingCuts) {
  const Sensor sensor = MakeObjectSensor();
  const MadeObject made = Standing("cup", {0.1, 0.2, 0.0}, {0.2, 0.15, 0.3});
  const Rigid3 camera = CameraOnCircle(0.4, 2.5, 0.8);
  Detection detection = Detect(made, sensor, camera);
  detection.lines.front().is_one_sided = true;
  const std::vector<ResolvedObservation> observations = {{KeyframeId(0), camera, &detection}};
  const Eigen::Quaterniond frame(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  const auto planes = SupportPlanesOf(sensor.camera, made.ellipsoid, observations, frame);
  ASSERT_EQ(planes.size(), detection.lines.size() - 1);
  const Ellipsoid in_frame = Rigid3(frame, Eigen::Vector3d::Zero()) * made.ellipsoid;
  for (const SupportPlane& plane : planes) {
    EXPECT_NEAR(plane.normal.norm(), 1.0, 1e-9);
    EXPECT_NEAR(plane.support, SupportOf(in_frame, plane.normal), 5e-3);
    EXPECT_NEAR(plane.pixels_per_metre, sensor.camera.fx / 2.6, 0.2 * sensor.camera.fx / 2.6);
  }
}

}  // namespace
}  // namespace hullslam

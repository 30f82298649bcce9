// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/body_overlap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

Body Box(const Vector3d& half, const Rigid3& pose = {}) { return {BodyKind::kBox, pose, half}; }

Body BoxAt(const Vector3d& center, const Vector3d& half = Vector3d::Ones()) {
  return Box(half, Rigid3(Eigen::Quaterniond::Identity(), center));
}

Body Moved(const Rigid3& motion, Body body) {
  body.world_from_body = motion * body.world_from_body;
  return body;
}

TEST(BodyOverlap, BoxesHaveTheirExactOverlap) {
  EXPECT_NEAR(BoxOverlap(BoxAt({0, 0, 0}), BoxAt({0, 0, 0})), 1.0, 1e-12);
  EXPECT_NEAR(BoxOverlap(BoxAt({0, 0, 0}), BoxAt({1, 0, 0})), 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(BoxOverlap(BoxAt({0, 0, 0}), BoxAt({1, 1, 1})), 1.0 / 15.0, 1e-12);
  EXPECT_NEAR(BoxOverlap(BoxAt({0, 0, 0}), BoxAt({0.2, 0.1, 0}, {0.5, 0.5, 0.5})), 0.125, 1e-12);
  EXPECT_NEAR(BoxOverlap(BoxAt({0, 0, 0}, {3, 0.1, 0.1}), BoxAt({0, 0, 0}, {0.1, 3, 0.1})),
              1.0 / 59.0, 1e-12)
      << "a cross";
}

TEST(BodyOverlap, BoxesThatTouchOrAreApartHaveNone) {
  EXPECT_EQ(BoxOverlap(BoxAt({0, 0, 0}), BoxAt({2, 0, 0})), 0.0);
  EXPECT_EQ(BoxOverlap(BoxAt({0, 0, 0}), BoxAt({2, 2, 0})), 0.0);
  EXPECT_EQ(BoxOverlap(BoxAt({0, 0, 0}), BoxAt({2.1, 0, 0})), 0.0);
  EXPECT_EQ(BoxOverlap(BoxAt({0, 0, 0}), BoxAt({50, 0, 0})), 0.0);
}

// Two squares, one turned by 45 degrees, meet in a regular octagon of 2 (sqrt 2 - 1) of their area.
// With all three axes the cube of side 2 and the same turned about its diagonal by 60 degrees meet
// in a double pyramid of 3/4 of its volume.
TEST(BodyOverlap, TurnedBoxesMeetInAPrismOrADoublePyramid) {
  for (int axis = 0; axis < 3; ++axis) {
    const Rigid3 turn(ExpSo3(kPi / 4.0 * Vector3d::Unit(axis)), Vector3d::Zero());
    EXPECT_NEAR(BoxOverlap(BoxAt({0, 0, 0}), Box({1, 1, 1}, turn)), std::sqrt(0.5), 1e-12);
  }
  const Rigid3 turn(ExpSo3(kPi / 3.0 * Vector3d::Ones().normalized()), Vector3d::Zero());
  EXPECT_NEAR(BoxOverlap(BoxAt({0, 0, 0}), Box({1, 1, 1}, turn)), 0.75 / 1.25, 1e-12);
}

TEST(BodyOverlap, IsSymmetricAndTheSameInEveryFrame) {
  RandomGeometry random(3);
  for (int i = 0; i < 200; ++i) {
    const auto half = [&] {
      return Vector3d(random.Number(0.1, 2), random.Number(0.1, 2), random.Number(0.1, 2));
    };
    const Body a = Box(half(), random.Pose(3.0, 1.0));
    const Body b = Box(half(), random.Pose(3.0, 1.0));
    const double overlap = BoxOverlap(a, b);
    EXPECT_NEAR(BoxOverlap(b, a), overlap, 1e-9);
    const Rigid3 motion = random.Pose(3.0, 100.0);
    EXPECT_NEAR(BoxOverlap(Moved(motion, a), Moved(motion, b)), overlap, 1e-9);
    EXPECT_NEAR(BoxOverlap(a, Moved(random.Pose(1e-15, 1e-15), a)), 1.0, 1e-9) << "rounded";
    // A box cut in two, along any of its axes, is covered by its halves.
    const int axis = i % 3;
    double sum = 0.0;
    for (const double side : {-0.5, 0.5}) {
      const Vector3d cut = Vector3d::Ones() - 0.5 * Vector3d::Unit(axis);
      const Vector3d shift = side * a.half_axes[axis] * Vector3d::Unit(axis);
      const Body part = Box(a.half_axes.cwiseProduct(cut),
                            a.world_from_body * Rigid3(Eigen::Quaterniond::Identity(), shift));
      const double share = BoxOverlap(part, b);
      sum += share / (1.0 + share) * (part.half_axes.prod() + b.half_axes.prod());
    }
    EXPECT_NEAR(sum, overlap / (1.0 + overlap) * (a.half_axes.prod() + b.half_axes.prod()), 1e-9);
  }
}

TEST(BodyOverlap, SolidsInsideEachOtherHaveTheRatioOfTheirVolumes) {
  RandomGeometry random(4);
  const Rigid3 pose = random.Pose(2.0, 5.0);
  const Vector3d half(0.3, 0.05, 0.2);
  const Body box = Box(half, pose);
  const Body cylinder = {BodyKind::kCylinder, pose, half};
  const Body ellipsoid = {BodyKind::kEllipsoid, pose, half};
  EXPECT_NEAR(box.Volume(), 8.0 * 0.003, 1e-15);
  EXPECT_NEAR(SolidOverlap(box, box), 1.0, 1e-9);
  EXPECT_NEAR(SolidOverlap(ellipsoid, ellipsoid), 1.0, 0.002);
  EXPECT_NEAR(SolidOverlap(ellipsoid, box), kPi / 6.0, 0.002);
  EXPECT_NEAR(SolidOverlap(cylinder, box), kPi / 4.0, 0.002);
  EXPECT_NEAR(SolidOverlap(cylinder, ellipsoid), 2.0 / 3.0, 0.002);
  EXPECT_EQ(BoxOverlap(ellipsoid, cylinder), BoxOverlap(box, box));
  const Body far = Moved(Rigid3(Eigen::Quaterniond::Identity(), {1, 0, 0}), ellipsoid);
  EXPECT_EQ(SolidOverlap(ellipsoid, far), 0.0);
}

// Unit spheres at the distance d have pi (4 + d) (2 - d)^2 / 12 in common. A linear map of both
// changes no ratio, so ellipsoids that are scaled like their distance have the same overlap.
TEST(BodyOverlap, EllipsoidsHaveTheOverlapOfALens) {
  RandomGeometry random(5);
  for (int i = 0; i < 50; ++i) {
    const double d = random.Number(0.0, 2.1);
    const double lens = d < 2.0 ? kPi * (4.0 + d) * (2.0 - d) * (2.0 - d) / 12.0 : 0.0;
    const double expected = lens / (8.0 / 3.0 * kPi - lens);
    const Vector3d half(random.Number(0.01, 1), random.Number(0.01, 1), random.Number(0.01, 1));
    const Vector3d offset = half.cwiseProduct(d * random.Vector(1.0).normalized());
    const Rigid3 pose = random.Pose(3.0, 10.0);
    const Body a = {BodyKind::kEllipsoid, pose, half};
    const Body b = {BodyKind::kEllipsoid, pose * Rigid3(Eigen::Quaterniond::Identity(), offset),
                    half};
    EXPECT_NEAR(SolidOverlap(a, b), expected, 0.005);
    EXPECT_NEAR(SolidOverlap(b, a), expected, 0.005);
  }
}

// Each box holds one half of the cylinder.
TEST(BodyOverlap, ABoxThatHalvesACylinderHasHalfOfIt) {
  const Body cylinder = {BodyKind::kCylinder, {}, {1.0, 1.0, 0.5}};
  EXPECT_NEAR(SolidOverlap(cylinder, BoxAt({1, 0, 0})), kPi / 2.0 / (8.0 + kPi / 2.0), 0.005);
  EXPECT_NEAR(SolidOverlap(cylinder, BoxAt({0, 0, 1.0})), kPi / 2.0 / (8.0 + kPi / 2.0), 0.005);
  const Rigid3 turn(ExpSo3({kPi / 2.0, 0, 0}), {0, 0, 0});
  EXPECT_NEAR(SolidOverlap(Moved(turn, cylinder), BoxAt({1, 0, 0})), kPi / 2.0 / (8.0 + kPi / 2.0),
              0.005);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/dual_quadric.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "support/random_geometry.h"

namespace hullslam {
namespace {

Eigen::Matrix3d Calibration() {
  Eigen::Matrix3d k;
  k << 520.0, 0.0, 320.0, 0.0, 510.0, 240.0, 0.0, 0.0, 1.0;
  return k;
}

Ellipsoid RandomEllipsoid(RandomGeometry& random) {
  return {random.Pose(2.0, 0.5),
          {random.Number(0.05, 0.4), random.Number(0.05, 0.4), random.Number(0.05, 0.4)}};
}

// A camera that looks at the neighbourhood of the origin from about 3 m.
Rigid3 RandomView(RandomGeometry& random) {
  const Rigid3 turned = random.Pose(2.0, 0.2);
  return Rigid3(Eigen::Quaterniond::Identity(), {0.0, 0.0, 3.0}) * turned;
}

Eigen::Vector3d SurfacePoint(const Ellipsoid& ellipsoid, RandomGeometry& random) {
  const Eigen::Vector3d on_sphere = random.Vector(1.0).normalized();
  return ellipsoid.world_from_object * on_sphere.cwiseProduct(ellipsoid.half_axes);
}

Eigen::Vector2d Pixel(const Rigid3& cam_from_world, const Eigen::Vector3d& point) {
  return (Calibration() * (cam_from_world * point)).hnormalized();
}

TEST(Ellipsoid, DualQuadricOfASphereMatchesHandComputedValues) {
  const Ellipsoid sphere{{Eigen::Quaterniond::Identity(), {1.0, 2.0, 3.0}}, {0.5, 0.5, 0.5}};
  const Eigen::Matrix4d dual = sphere.DualQuadric();
  EXPECT_DOUBLE_EQ(dual(3, 3), -1.0);
  EXPECT_DOUBLE_EQ(dual(0, 0), 0.25 - 1.0);
  EXPECT_DOUBLE_EQ(dual(0, 1), -2.0);
  // The plane z = 3.5 touches the sphere. For z = 4, h^2 - d^2 = 0.25 - 1.
  const Eigen::Vector4d touching(0.0, 0.0, 1.0, -3.5);
  const Eigen::Vector4d beyond(0.0, 0.0, 1.0, -4.0);
  EXPECT_NEAR(touching.dot(dual * touching), 0.0, 1e-14);
  EXPECT_NEAR(beyond.dot(dual * beyond), -0.75, 1e-14);
}

TEST(Ellipsoid, DualQuadricIsZTimesDiagonalTimesZ) {
  RandomGeometry random(1);
  const Ellipsoid ellipsoid = RandomEllipsoid(random);
  Eigen::Matrix4d z = Eigen::Matrix4d::Identity();
  z.topRows<3>() = ellipsoid.world_from_object.ToMatrix();
  const Eigen::Vector4d diagonal = ellipsoid.half_axes.cwiseAbs2().homogeneous();
  const Eigen::Vector4d signs(1.0, 1.0, 1.0, -1.0);
  const Eigen::Matrix4d expected = z * diagonal.cwiseProduct(signs).asDiagonal() * z.transpose();
  EXPECT_LT((ellipsoid.DualQuadric() - expected).norm(), 1e-14);
}

TEST(Ellipsoid, TangentPlanesAreOnTheDualQuadric) {
  RandomGeometry random(2);
  for (int i = 0; i < 100; ++i) {
    const Ellipsoid ellipsoid = RandomEllipsoid(random);
    // At the point s * u of the surface, in the frame of the object, the normal is along u / s.
    const Eigen::Vector3d u = random.Vector(1.0).normalized();
    const Eigen::Vector3d point = ellipsoid.world_from_object * u.cwiseProduct(ellipsoid.half_axes);
    const Eigen::Vector3d normal =
        (ellipsoid.world_from_object.rotation * u.cwiseQuotient(ellipsoid.half_axes)).normalized();
    Eigen::Vector4d plane;
    plane << normal, -normal.dot(point);
    EXPECT_NEAR(plane.dot(ellipsoid.DualQuadric() * plane), 0.0, 1e-14);
    plane[3] -= 0.01;  // 1 cm off the surface
    EXPECT_LT(plane.dot(ellipsoid.DualQuadric() * plane), -1e-4);
  }
}

TEST(Ellipsoid, MovesWithItsFrame) {
  RandomGeometry random(3);
  for (int i = 0; i < 50; ++i) {
    const Ellipsoid ellipsoid = RandomEllipsoid(random);
    const Rigid3 b_from_world = random.Pose(2.0, 3.0);
    Eigen::Matrix4d t = Eigen::Matrix4d::Identity();
    t.topRows<3>() = b_from_world.ToMatrix();
    const Eigen::Matrix4d expected = t * ellipsoid.DualQuadric() * t.transpose();
    EXPECT_LT(((b_from_world * ellipsoid).DualQuadric() - expected).norm(), 1e-12);
  }
}

TEST(Ellipsoid, GrowsWithASimilarity) {
  RandomGeometry random(6);
  for (int i = 0; i < 50; ++i) {
    const Ellipsoid ellipsoid = RandomEllipsoid(random);
    const Rigid3 rigid = random.Pose(2.0, 3.0);
    const Sim3 b_from_world(1.0 + 0.05 * i, rigid.rotation, rigid.translation);
    const Ellipsoid moved = b_from_world * ellipsoid;
    const Eigen::Vector3d surface = SurfacePoint(ellipsoid, random);
    EXPECT_NEAR(moved.RadialDistance(b_from_world * surface), 0.0, 1e-9);
  }
}

TEST(Ellipsoid, RadialDistanceIsZeroOnTheSurfaceAndAlongTheRay) {
  RandomGeometry random(4);
  for (int i = 0; i < 100; ++i) {
    const Ellipsoid ellipsoid = RandomEllipsoid(random);
    const Eigen::Vector3d center = ellipsoid.world_from_object.translation;
    const Eigen::Vector3d surface = SurfacePoint(ellipsoid, random);
    const Eigen::Vector3d ray = (surface - center).normalized();
    EXPECT_NEAR(ellipsoid.RadialDistance(surface), 0.0, 1e-14);
    EXPECT_NEAR(ellipsoid.RadialDistance(surface + 0.3 * ray), 0.3, 1e-13);
    EXPECT_NEAR(ellipsoid.RadialDistance(surface - 0.04 * ray), -0.04, 1e-13);
  }
  const Ellipsoid ellipsoid{random.Pose(1.0, 1.0), {0.3, 0.1, 0.2}};
  EXPECT_DOUBLE_EQ(ellipsoid.RadialDistance(ellipsoid.world_from_object.translation), -0.1);
}

// The image of a sphere on the optical axis is a circle. The rays through this circle touch the
// sphere.
TEST(ProjectEllipsoid, OfASphereOnTheAxisMatchesHandComputedValues) {
  const Eigen::Matrix3d k = Eigen::Vector3d(500.0, 500.0, 1.0).asDiagonal();
  const Ellipsoid sphere{{Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.0}}, {0.5, 0.5, 0.5}};
  const auto ellipse = ProjectEllipsoid(k, Rigid3(), sphere);
  ASSERT_TRUE(ellipse);
  const double tangent = 0.5 / std::sqrt(4.0 - 0.25);
  EXPECT_LT(ellipse->center.norm(), 1e-12);
  EXPECT_NEAR(ellipse->HalfExtent({0.6, 0.8}), 500.0 * tangent, 1e-10);
}

TEST(ProjectEllipsoid, ContainsAllPixelsOfTheSurfaceAndTouchesThem) {
  RandomGeometry random(5);
  for (int i = 0; i < 20; ++i) {
    const Ellipsoid ellipsoid = RandomEllipsoid(random);
    const Rigid3 cam_from_world = RandomView(random);
    const auto ellipse = ProjectEllipsoid(Calibration(), cam_from_world, ellipsoid);
    ASSERT_TRUE(ellipse);
    const Eigen::Matrix2d inverse = ellipse->shape.inverse();
    double outermost = 0.0;
    for (int k = 0; k < 20000; ++k) {
      const Eigen::Vector2d p =
          Pixel(cam_from_world, SurfacePoint(ellipsoid, random)) - ellipse->center;
      outermost = std::max(outermost, p.dot(inverse * p));
    }
    EXPECT_LE(outermost, 1.0 + 1e-9);
    EXPECT_GT(outermost, 0.9999);
  }
}

// A plane through the camera centre that touches the ellipsoid is seen as a line that touches the
// projected ellipse: l^T P Q* P^T l = 0.
TEST(ProjectEllipsoid, TangentsOfTheEllipseBackprojectToTangentPlanes) {
  RandomGeometry random(6);
  for (int i = 0; i < 50; ++i) {
    const Ellipsoid ellipsoid = RandomEllipsoid(random);
    const Rigid3 cam_from_world = RandomView(random);
    const auto ellipse = ProjectEllipsoid(Calibration(), cam_from_world, ellipsoid);
    ASSERT_TRUE(ellipse);
    const double angle = random.Number(0.0, 6.3);
    const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
    const Eigen::Vector3d line(n.x(), n.y(), -n.dot(ellipse->center) - ellipse->HalfExtent(n));
    Eigen::Vector4d plane = (Calibration() * cam_from_world.ToMatrix()).transpose() * line;
    plane /= plane.head<3>().norm();
    EXPECT_NEAR(plane.dot(ellipsoid.DualQuadric() * plane), 0.0, 1e-12);
  }
}

TEST(ProjectEllipsoid, IsInvariantUnderACommonMotion) {
  RandomGeometry random(7);
  for (int i = 0; i < 50; ++i) {
    const Ellipsoid ellipsoid = RandomEllipsoid(random);
    const Rigid3 cam_from_world = RandomView(random);
    const Rigid3 moved_from_world = random.Pose(3.0, 10.0);
    const auto before = ProjectEllipsoid(Calibration(), cam_from_world, ellipsoid);
    const auto after = ProjectEllipsoid(Calibration(), cam_from_world * Inverse(moved_from_world),
                                        moved_from_world * ellipsoid);
    ASSERT_TRUE(before);
    ASSERT_TRUE(after);
    EXPECT_LT((before->center - after->center).norm(), 1e-9);
    EXPECT_LT((before->shape - after->shape).norm(), 1e-6);
  }
}

TEST(ProjectEllipsoid, IsNothingUnlessTheWholeEllipsoidIsInFront) {
  const auto at_depth = [](double z) {
    const Ellipsoid ellipsoid{{ExpSo3({0.0, std::numbers::pi / 2.0, 0.0}), {0.1, 0.2, z}},
                              {0.5, 0.2, 0.1}};  // reaches 0.5 m along the view
    return ProjectEllipsoid(Calibration(), Rigid3(), ellipsoid);
  };
  EXPECT_TRUE(at_depth(2.0));
  EXPECT_TRUE(at_depth(0.51));
  EXPECT_FALSE(at_depth(0.49));  // crosses the plane of the camera
  EXPECT_FALSE(at_depth(0.0));
  EXPECT_FALSE(at_depth(-0.49));
  EXPECT_FALSE(at_depth(-2.0));  // behind the camera, where C*33 < 0 too
  EXPECT_FALSE(at_depth(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace hullslam

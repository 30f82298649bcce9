// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/reprojection.h"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>

#include "costs/cost_laws.h"
#include "costs/reprojection_camera.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

PointMeasurement Measurement(const Eigen::Vector2d& pixel, double sigma) {
  return PointMeasurement::Create(pixel, sigma, std::nullopt, {.pixel_sigma = 1.0});
}

TEST(ReprojectionCost, ByHand) {
  // The world is turned by a quarter turn around z and moved: (0.5, 0, 1) is (1, -0.5, 2) in the
  // camera frame, which is pixel (500 / 2 + 320, -400 / 4 + 240).
  const Rigid3 cam_from_world(ExpSo3({0.0, 0.0, std::numbers::pi / 2.0}), {1.0, -1.0, 1.0});
  const ReprojectionCost cost(kReprojectionCamera, Measurement({567.0, 144.0}, 2.0));
  const Eigen::Vector2d residual = ResidualOf<2>(cost, cam_from_world, {0.5, 0.0, 1.0});
  EXPECT_NEAR(residual.x(), 1.5, 1e-12);
  EXPECT_NEAR(residual.y(), -2.0, 1e-12);
}

TEST(ReprojectionCost, DerivativeByThePointByHand) {
  const ReprojectionCost cost(kReprojectionCamera, Measurement({0.0, 0.0}, 0.5));
  const PoseBlock pose = ToBlock(Rigid3());
  const Eigen::Vector3d point(1.0, -0.5, 2.0);
  const double* parameters[] = {pose.data(), point.data()};
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> by_point;
  double* jacobians[] = {nullptr, by_point.data()};
  ASSERT_TRUE(cost.Evaluate(parameters, residual.data(), jacobians));
  Eigen::Matrix<double, 2, 3> expected;  // twice the Jacobian of the projection, as sigma is 0.5
  expected << 500.0, 0.0, -250.0, 0.0, 400.0, 100.0;
  EXPECT_LT((by_point - expected).norm(), 1e-12);
}

TEST(ReprojectionCost, GradientIsTrue) {
  RandomGeometry random(1);
  for (int i = 0; i < 30; ++i) {
    const Rigid3 cam_from_world = random.Pose(1.0, 1.0);
    const Eigen::Vector3d in_cam = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 3.0);
    const ReprojectionCost cost(kReprojectionCamera,
                                Measurement({random.Number(0, 640), random.Number(0, 480)}, 1.44));
    ExpectTrueGradient<2>(cost, cam_from_world, Inverse(cam_from_world) * in_cam);
  }
}

TEST(ReprojectionCost, DoesNotDependOnTheWorldFrame) {
  RandomGeometry random(2);
  const ReprojectionCost cost(kReprojectionCamera, Measurement({100.0, 200.0}, 1.2));
  for (int i = 0; i < 30; ++i) {
    const Rigid3 cam_from_world = random.Pose(1.0, 1.0);
    const Eigen::Vector3d in_cam = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 3.0);
    ExpectRigidInvariance<2>(cost, cam_from_world, Inverse(cam_from_world) * in_cam,
                             random.Pose(2.0, 5.0));
  }
}

TEST(ReprojectionCost, TheScaleOfTheWorldDoesNotMatter) {
  RandomGeometry random(3);
  const ReprojectionCost cost(kReprojectionCamera, Measurement({100.0, 200.0}, 1.2));
  for (const double scale : {0.5, 0.99, 3.0}) {
    Rigid3 cam_from_world = random.Pose(1.0, 1.0);
    const Eigen::Vector3d point =
        Inverse(cam_from_world) * (random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 3.0));
    const Eigen::Vector2d residual = ResidualOf<2>(cost, cam_from_world, point);
    cam_from_world.translation *= scale;
    EXPECT_LT((ResidualOf<2>(cost, cam_from_world, scale * point) - residual).norm(), 1e-9);
  }
}

TEST(ReprojectionCost, IsNotDefinedBehindTheCamera) {
  const ReprojectionCost cost(kReprojectionCamera, Measurement({320.0, 240.0}, 1.0));
  const PoseBlock pose = ToBlock(Rigid3());
  Eigen::Vector2d residual;
  for (const double z : {-2.0, -1e-9, 0.0, 1e-6}) {
    const Eigen::Vector3d point(0.1, 0.1, z);
    const double* parameters[] = {pose.data(), point.data()};
    EXPECT_FALSE(cost.Evaluate(parameters, residual.data(), nullptr)) << z;
  }
}

PointMeasurement RgbdMeasurement(const Eigen::Vector3d& measured, double pixel_sigma) {
  return PointMeasurement::Create(
      measured.head<2>(), pixel_sigma, measured.z(),
      {.pixel_sigma = 1.0, .adjustment_pixel_sigma = 1.0, .disparity_sigma = 0.5});
}

TEST(RgbdReprojectionCost, ByHand) {
  // (1, -0.5, 2) in the camera frame is pixel (570, 140) and has a disparity of 40 / 2 px. The
  // sigma of the pixel does not affect the residual of the disparity.
  const Rigid3 cam_from_world(Eigen::Quaterniond::Identity(), {0.0, 0.0, -1.0});
  const RgbdReprojectionCost cost(kReprojectionCamera, RgbdMeasurement({569.0, 142.0, 17.0}, 2.0));
  const Eigen::Vector3d residual = ResidualOf<3>(cost, cam_from_world, {1.0, -0.5, 3.0});
  EXPECT_LT((residual - Eigen::Vector3d(0.5, -1.0, 6.0)).norm(), 1e-12);
}

// So bundle adjustment measures the same error as tracking and mapping, which use PointResidual
// itself.
TEST(RgbdReprojectionCost, IsTheResidualOfThePoint) {
  RandomGeometry random(4);
  for (int i = 0; i < 30; ++i) {
    const Rigid3 cam_from_world = random.Pose(1.0, 1.0);
    const Eigen::Vector3d in_cam = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 3.0);
    const PointMeasurement measurement =
        RgbdMeasurement({random.Number(0, 640), random.Number(0, 480), random.Number(5, 40)}, 1.44);
    const Eigen::Vector3d residual =
        ResidualOf<3>(RgbdReprojectionCost(kReprojectionCamera, measurement), cam_from_world,
                      Inverse(cam_from_world) * in_cam);
    EXPECT_LT((residual - PointResidual(kReprojectionCamera, measurement, in_cam)).norm(), 1e-8);
  }
}

TEST(RgbdReprojectionCost, GradientIsTrue) {
  RandomGeometry random(1);
  for (int i = 0; i < 30; ++i) {
    const Rigid3 cam_from_world = random.Pose(1.0, 1.0);
    const Eigen::Vector3d in_cam = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 3.0);
    const Eigen::Vector3d measured(random.Number(0, 640), random.Number(0, 480),
                                   random.Number(5, 40));
    const RgbdReprojectionCost cost(kReprojectionCamera, RgbdMeasurement(measured, 1.44));
    ExpectTrueGradient<3>(cost, cam_from_world, Inverse(cam_from_world) * in_cam);
  }
}

TEST(RgbdReprojectionCost, DoesNotDependOnTheWorldFrame) {
  RandomGeometry random(2);
  const RgbdReprojectionCost cost(kReprojectionCamera, RgbdMeasurement({100.0, 200.0, 10.0}, 1.2));
  for (int i = 0; i < 30; ++i) {
    const Rigid3 cam_from_world = random.Pose(1.0, 1.0);
    const Eigen::Vector3d in_cam = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 3.0);
    ExpectRigidInvariance<3>(cost, cam_from_world, Inverse(cam_from_world) * in_cam,
                             random.Pose(2.0, 5.0));
  }
}

TEST(RgbdReprojectionCost, FirstTwoRowsAreThoseWithoutDepth) {
  RandomGeometry random(3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d measured = 100.0 * (random.Vector(1.0) + Eigen::Vector3d::Constant(2.0));
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 3.0);
    const Rigid3 pose = random.Pose(0.1, 0.1);
    const Eigen::Vector3d with = ResidualOf<3>(
        RgbdReprojectionCost(kReprojectionCamera, RgbdMeasurement(measured, 1.2)), pose, point);
    const Eigen::Vector2d without = ResidualOf<2>(
        ReprojectionCost(kReprojectionCamera, RgbdMeasurement(measured, 1.2)), pose, point);
    EXPECT_EQ(Eigen::Vector2d(with.head<2>()), without);
  }
}

// When the point moves along the ray, only the third row changes. So this row constrains the depth.
TEST(RgbdReprojectionCost, OnlyTheThirdRowDependsOnTheDepth) {
  const RgbdReprojectionCost cost(kReprojectionCamera, RgbdMeasurement({320.0, 240.0, 20.0}, 1.0));
  EXPECT_LT(ResidualOf<3>(cost, Rigid3(), {0.0, 0.0, 2.0}).norm(), 1e-12);
  const Eigen::Vector3d farther = ResidualOf<3>(cost, Rigid3(), {0.0, 0.0, 4.0});
  EXPECT_LT((farther - Eigen::Vector3d(0.0, 0.0, -20.0)).norm(), 1e-12);
}

TEST(RgbdReprojectionCost, IsNotDefinedBehindTheCamera) {
  const RgbdReprojectionCost cost(kReprojectionCamera, RgbdMeasurement({320.0, 240.0, 20.0}, 1.0));
  const PoseBlock pose = ToBlock(Rigid3());
  Eigen::Vector3d residual;
  for (const double z : {-2.0, 0.0, 1e-6}) {
    const Eigen::Vector3d point(0.1, 0.1, z);
    const double* parameters[] = {pose.data(), point.data()};
    EXPECT_FALSE(cost.Evaluate(parameters, residual.data(), nullptr)) << z;
  }
}

}  // namespace
}  // namespace hullslam

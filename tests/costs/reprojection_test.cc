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

}  // namespace
}  // namespace hullslam

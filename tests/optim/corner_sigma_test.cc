// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/corner_sigma.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "hullslam/geometry/rigid3.h"
#include "support/fisheye_camera.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

const PinholeCamera kMadeCamera = SyntheticSensor().camera;  // f 500, centre 320, 240

Matrix6d Information(double rotation_sigma, double translation_sigma) {
  Eigen::Matrix<double, 6, 1> sigmas;
  sigmas << Eigen::Vector3d::Constant(rotation_sigma), Eigen::Vector3d::Constant(translation_sigma);
  return sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
}

// The image is 640 x 480, so all corners are at the slope n = (0.64, 0.48), |n| = 0.8. A
// translation (a, b, c) at the depth z moves a corner by f / z ((a, b) - c n). So the covariance is
// (s f / z)^2 (I + n n^T), whose largest eigenvalue is (s f / z)^2 (1 + |n|^2).
TEST(CornerSigma, OfATranslationIsAsComputedByHand) {
  const double expected = 0.01 * 500.0 / 2.0 * std::sqrt(1.0 + 0.64);
  EXPECT_NEAR(CornerSigma(kMadeCamera, Information(1e-9, 0.01), 2.0), expected, 1e-6);
}

// A rotation about an axis across n moves the corner along n by f (1 + |n|^2) per radian.
TEST(CornerSigma, OfARotationDoesNotDependOnTheDepth) {
  const double expected = 0.01 * 500.0 * 1.64;
  EXPECT_NEAR(CornerSigma(kMadeCamera, Information(0.01, 1e-9), 2.0), expected, 1e-6);
  EXPECT_NEAR(CornerSigma(kMadeCamera, Information(0.01, 1e-9), 20.0), expected, 1e-6);
}

TEST(CornerSigma, DoesNotDependOnTheUnitOfLength) {
  EXPECT_NEAR(CornerSigma(kMadeCamera, Information(0.003, 0.02), 2.0),
              CornerSigma(kMadeCamera, Information(0.003, 0.06), 6.0), 1e-9);
}

// A pose that turns about one side of the image is uncertain at the other side, whichever it is.
// The translation that belongs to the turn keeps points at the depth 2 and the slope `side` in
// place.
TEST(CornerSigma, IsThatOfTheWorstCornerOnEverySide) {
  const auto sigma_about = [](const Eigen::Vector2d& side) {
    Matrix6d covariance = 1e-8 * Matrix6d::Identity();
    Eigen::Matrix<double, 6, 1> turn;  // about the axis across the side
    turn.head<3>() << side.y(), -side.x(), 0.0;
    turn.head<3>().normalize();
    const Eigen::Vector3d fixed(2.0 * side.x(), 2.0 * side.y(), 2.0);
    turn.tail<3>() = -turn.head<3>().cross(fixed);
    covariance += 1e-4 * turn * turn.transpose();
    return CornerSigma(kMadeCamera, covariance.inverse(), 2.0);
  };
  const double left = sigma_about({-0.64, 0.0});
  EXPECT_GT(left, 5.0);
  EXPECT_NEAR(sigma_about({0.64, 0.0}), left, 1e-6);
  const double top = sigma_about({0.0, -0.48});
  EXPECT_GT(top, 3.0);
  EXPECT_NEAR(sigma_about({0.0, 0.48}), top, 1e-6);
}

// A turn about the axis of the lens moves the corner of the raw image along a circle of its radius.
TEST(CornerSigma, IsMeasuredInTheRawImageOfAFisheyeLens) {
  PinholeCamera camera = FisheyeCamera();
  camera.cx = 320.0;
  camera.cy = 240.0;
  camera.fy = camera.fx;
  Matrix6d information = Information(1e-9, 1e-9);
  information(2, 2) = 1.0 / (0.01 * 0.01);
  // The lens has 150 degrees across: the corners, beyond 80 degrees, are not seen.
  const double radius =
      (camera.Distort(camera.Undistort({0.0, 0.0})) - Eigen::Vector2d(camera.cx, camera.cy)).norm();
  EXPECT_LT(radius, 399.0);
  EXPECT_NEAR(CornerSigma(camera, information, 2.0), 0.01 * radius, 1e-3);
}

// The same lens in the model of a pinhole and in that of a fisheye.
TEST(CornerSigma, DoesNotDependOnTheModelOfTheLens) {
  PinholeCamera pinhole = PinholeAsFisheye();
  pinhole.lens = LensModel::kBrown;
  pinhole.k1 = pinhole.k2 = pinhole.k3 = pinhole.k4 = 0.0;
  const Matrix6d information = Information(0.003, 0.02);
  const double expected = CornerSigma(pinhole, information, 2.0);
  EXPECT_NEAR(CornerSigma(PinholeAsFisheye(), information, 2.0), expected, 0.01 * expected);
}

// The corners are those of the raw image, whose undistorted ones are farther out with this lens.
TEST(CornerSigma, TakesTheCornersOfTheRawImage) {
  PinholeCamera barrel = kMadeCamera;
  barrel.k1 = -0.2;
  const Eigen::Vector3d ray = barrel.Unproject(barrel.Undistort({0.0, 0.0}), 1.0);
  ASSERT_GT(ray.head<2>().norm(), 0.85);
  constexpr double kStep = 1e-5;
  Eigen::Matrix<double, 2, 3> raw_by_turn;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d turn = kStep * Eigen::Vector3d::Unit(i);
    raw_by_turn.col(i) = (barrel.Distort(barrel.Project(ExpSo3(turn) * ray)) -
                          barrel.Distort(barrel.Project(ExpSo3(-turn) * ray))) /
                         (2.0 * kStep);
  }
  const double largest = std::sqrt(
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(raw_by_turn * raw_by_turn.transpose())
          .eigenvalues()[1]);
  EXPECT_NEAR(CornerSigma(barrel, Information(0.01, 1e-9), 2.0), 0.01 * largest, 1e-4);
}

TEST(CornerSigma, IsInfiniteForAPoseThatIsNotDetermined) {
  Matrix6d information = Information(0.01, 0.01);
  information.row(4).setZero();
  information.col(4).setZero();
  EXPECT_EQ(CornerSigma(kMadeCamera, information, 2.0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace hullslam

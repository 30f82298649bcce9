// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/corner_sigma.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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

TEST(CornerSigma, IsInfiniteForAPoseThatIsNotDetermined) {
  Matrix6d information = Information(0.01, 0.01);
  information.row(4).setZero();
  information.col(4).setZero();
  EXPECT_EQ(CornerSigma(kMadeCamera, information, 2.0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/point_measurement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "support/fisheye_camera.h"
#include "support/random_geometry.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr PinholeCamera kCamera{.fx = 500.0, .fy = 400.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};

TEST(ProjectRgbd, ByHand) {
  const Eigen::Vector3d point(1.0, -0.5, 2.0);
  EXPECT_EQ(ProjectRgbd(kCamera, point), Eigen::Vector3d(570.0, 140.0, 20.0));
  Eigen::Matrix3d expected;
  expected << 250.0, 0.0, -125.0, 0.0, 200.0, 50.0, 0.0, 0.0, -10.0;
  EXPECT_LT((ProjectRgbdJacobian(kCamera, point) - expected).norm(), 1e-12);
}

TEST(ProjectRgbd, PixelIsThatOfTheCamera) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 2.0);
    EXPECT_LT((ProjectRgbd(kCamera, point).head<2>() - kCamera.Project(point)).norm(), 1e-10);
  }
}

TEST(ProjectRgbd, DerivativeIsTrue) {
  RandomGeometry random(1);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 2.5);
    const Eigen::Matrix3d jacobian = ProjectRgbdJacobian(kCamera, point);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d slope =
          (ProjectRgbd(kCamera, point + step) - ProjectRgbd(kCamera, point - step)) / (2.0 * kStep);
      EXPECT_LT((slope - jacobian.col(axis)).norm(), 1e-5);
    }
  }
}

TEST(ProjectRgbd, PixelDoesNotChangeAlongTheRayAndDisparityFallsWithDepth) {
  RandomGeometry random(2);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 2.5);
    const Eigen::Vector3d near = ProjectRgbd(kCamera, point);
    const Eigen::Vector3d far = ProjectRgbd(kCamera, 3.0 * point);
    EXPECT_LT((near.head<2>() - far.head<2>()).norm(), 1e-10);
    EXPECT_NEAR(near.z(), 3.0 * far.z(), 1e-10);
  }
}

PointMeasurement Measure(const Eigen::Vector2d& pixel, std::optional<double> disparity) {
  return PointMeasurement::Create(
      pixel, 4.0, disparity,
      {.pixel_sigma = 0.5, .adjustment_pixel_sigma = 0.5, .disparity_sigma = 0.5});
}

// (1, -0.5, 2) is seen at pixel (570, 140) with a disparity of 20.
TEST(PointResidual, ByHand) {
  const Eigen::Vector3d point(1.0, -0.5, 2.0);
  const PointMeasurement with_depth = Measure({569.0, 142.0}, 17.0);
  EXPECT_LT((PointResidual(kCamera, with_depth, point) - Eigen::Vector3d(0.5, -1.0, 6.0)).norm(),
            1e-12);
  EXPECT_NEAR(PointChi2(kCamera, with_depth, point), 37.25, 1e-12);
  const PointMeasurement without_depth = Measure({569.0, 142.0}, std::nullopt);
  EXPECT_LT((PointResidual(kCamera, without_depth, point) - Eigen::Vector3d(0.5, -1.0, 0.0)).norm(),
            1e-12);
  EXPECT_NEAR(PointChi2(kCamera, without_depth, point), 1.25, 1e-12);
}

TEST(PointResidual, DerivativeByHand) {
  Eigen::Matrix3d expected;  // that of the projection, times 1/2, 1/2 and 2
  expected << 125.0, 0.0, -62.5, 0.0, 100.0, 25.0, 0.0, 0.0, -20.0;
  const Eigen::Vector3d point(1.0, -0.5, 2.0);
  EXPECT_LT((PointResidualJacobian(kCamera, Measure({0.0, 0.0}, 1.0), point) - expected).norm(),
            1e-12);
  expected.row(2).setZero();
  EXPECT_LT(
      (PointResidualJacobian(kCamera, Measure({0.0, 0.0}, std::nullopt), point) - expected).norm(),
      1e-12);
}

TEST(PointResidual, DerivativeIsTrue) {
  RandomGeometry random(3);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 2.5);
    const PointMeasurement measurement =
        Measure({random.Number(0, 640), random.Number(0, 480)},
                i % 2 == 0 ? std::optional(random.Number(5, 40)) : std::nullopt);
    const Eigen::Matrix3d jacobian = PointResidualJacobian(kCamera, measurement, point);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d slope = (PointResidual(kCamera, measurement, point + step) -
                                     PointResidual(kCamera, measurement, point - step)) /
                                    (2.0 * kStep);
      EXPECT_LT((slope - jacobian.col(axis)).norm(), 1e-5);
    }
  }
}

TEST(PointLinearization, IsTheResidualAndItsDerivative) {
  RandomGeometry random(4);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 2.5);
    const PointMeasurement measurement =
        Measure({random.Number(0, 640), random.Number(0, 480)},
                i % 2 == 0 ? std::optional(random.Number(5, 40)) : std::nullopt);
    const PointLinearization linear(kCamera, measurement, point);
    const Eigen::Vector3d residual = PointResidual(kCamera, measurement, point);
    const Eigen::Matrix3d jacobian = PointResidualJacobian(kCamera, measurement, point);
    EXPECT_LT((linear.residual - residual).norm(), 1e-9);
    EXPECT_LT((linear.Gradient() - jacobian.transpose() * residual).norm(), 1e-6);
    EXPECT_LT((linear.Hessian() - jacobian.transpose() * jacobian).norm(), 1e-6);
    const Eigen::Matrix3d rotation = random.Pose(2.0, 0.0).rotation.toRotationMatrix();
    EXPECT_LT((linear.Times(rotation) - jacobian * rotation).norm(), 1e-9);
  }
}

// The error of depth does not depend on the pyramid level that the keypoint was found at.
TEST(PointResidual, ThePyramidLevelDoesNotChangeTheDisparity) {
  const Eigen::Vector3d point(0.3, 0.2, 1.5);
  const DepthErrorOptions options;
  const auto residual = [&](double scale) {
    return PointResidual(kCamera, PointMeasurement::Create({400.0, 300.0}, scale, 20.0, options),
                         point);
  };
  EXPECT_EQ(residual(1.0).z(), residual(3.0).z());
  EXPECT_NEAR(residual(1.0).x(), 3.0 * residual(3.0).x(), 1e-12);
  EXPECT_NEAR(residual(1.0).y(), 3.0 * residual(3.0).y(), 1e-12);
}

// An unknown depth is not the same as a depth at infinity, whose disparity is 0.
TEST(PointMeasurement, ADisparityOfZeroIsADepth) {
  EXPECT_TRUE(Measure({0.0, 0.0}, 0.0).has_depth());
  EXPECT_FALSE(Measure({0.0, 0.0}, std::nullopt).has_depth());
}

TEST(PointMeasurement, TheBoundFitsTheNumberOfResiduals) {
  const PointMeasurement with_depth = Measure({0.0, 0.0}, 20.0);
  const PointMeasurement without_depth = Measure({0.0, 0.0}, std::nullopt);
  EXPECT_EQ(with_depth.degrees_of_freedom(), 3u);
  EXPECT_EQ(without_depth.degrees_of_freedom(), 2u);
  EXPECT_EQ(OutlierBound(with_depth), Chi2Bound(3));
  EXPECT_EQ(OutlierBound(without_depth), Chi2Bound(2));
}

// Errors along u of a point that is straight ahead, in units of the pixel's sigma, 2 px: squared
// they are on either side of 5.991 and of 7.815.
TEST(IsInlier, ComparesWithTheBound) {
  const Eigen::Vector3d point(0.0, 0.0, 2.0);
  const auto is_inlier = [&](double error, std::optional<double> disparity) {
    return IsInlier(kCamera, Measure({320.0 + 2.0 * error, 240.0}, disparity), point);
  };
  EXPECT_TRUE(is_inlier(2.44, std::nullopt));
  EXPECT_FALSE(is_inlier(2.46, std::nullopt));
  EXPECT_TRUE(is_inlier(2.79, 20.0));
  EXPECT_FALSE(is_inlier(2.80, 20.0));
  EXPECT_TRUE(is_inlier(0.0, 20.0 + 0.5 * 2.79));
  EXPECT_FALSE(is_inlier(0.0, 20.0 + 0.5 * 2.80));
}

TEST(IsInlier, APointBehindTheCameraIsNone) {
  for (const double z : {-2.0, 0.0, 1e-6}) {
    const Eigen::Vector3d point(0.0, 0.0, z);
    EXPECT_EQ(PointChi2(kCamera, Measure({320.0, 240.0}, std::nullopt), point),
              std::numeric_limits<double>::infinity());
    EXPECT_FALSE(IsInlier(kCamera, Measure({320.0, 240.0}, std::nullopt), point)) << z;
  }
}

TEST(PointMeasurement, IsValidWithFiniteNumbersAndAWeight) {
  const PointMeasurement valid = PointMeasurement::Create({1.0, 2.0}, 1.0, 3.0, {});
  EXPECT_TRUE(valid.IsValid());
  EXPECT_TRUE(PointMeasurement::Create({1.0, 2.0}, 1.0, std::nullopt, {}).IsValid());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 3; ++i) {
    PointMeasurement broken = valid;
    broken.measured[i] = nan;
    EXPECT_FALSE(broken.IsValid());
    broken = valid;
    broken.inverse_sigma[i] = nan;
    EXPECT_FALSE(broken.IsValid());
    broken.inverse_sigma[i] = -1.0;
    EXPECT_FALSE(broken.IsValid());
  }
  PointMeasurement weightless = valid;
  weightless.inverse_sigma.x() = 0.0;
  EXPECT_FALSE(weightless.IsValid());
}

// Measurements of a fisheye lens, whose errors are those of the raw pixel.
PointMeasurement MeasureFisheye(const Eigen::Vector2d& pixel, std::optional<double> disparity) {
  PointMeasurement measurement = Measure(pixel, disparity);
  measurement.TakeLens(FisheyeCamera().DistortionJacobian(pixel));
  return measurement;
}

TEST(PointMeasurement, TheErrorOfAFisheyeIsThatOfItsRawPixel) {
  const PinholeCamera camera = FisheyeCamera();
  for (const Eigen::Vector3d& ray :
       {Eigen::Vector3d(0.1, 0.2, 1.0), {2.0, 1.0, 1.0}, {-3.0, 2.0, 1.0}, {1.0, -4.0, 1.0}}) {
    const Eigen::Vector2d raw = camera.Distort(camera.Project(ray));
    const PointMeasurement measurement = MeasureFisheye(camera.Project(ray), std::nullopt);
    for (const Eigen::Vector2d& error : {Eigen::Vector2d(0.2, 0.0), {0.0, 0.2}, {-0.15, 0.1}}) {
      const Eigen::Vector3d seen = camera.Unproject(camera.Undistort(raw + error), 2.0);
      // Sigma is 2 px.
      EXPECT_NEAR(std::sqrt(PointChi2(camera, measurement, seen)), error.norm() / 2.0,
                  0.005 * error.norm());
    }
  }
}

TEST(PointMeasurement, TheLensDoesNotChangeTheErrorOfTheDisparity) {
  const PinholeCamera camera = FisheyeCamera();
  const PointMeasurement measurement = MeasureFisheye({900.0, 500.0}, 12.0);
  const Eigen::Vector3d point = camera.Unproject({900.0, 500.0}, camera.bf / 13.0);
  EXPECT_LT((PointResidual(camera, measurement, point) - Eigen::Vector3d(0.0, 0.0, 2.0)).norm(),
            1e-9);
}

TEST(PointMeasurement, DerivativesWithALensAreTrue) {
  const PinholeCamera camera = FisheyeCamera();
  RandomGeometry random(5);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d point = random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 1.5);
    const PointMeasurement measurement =
        MeasureFisheye({random.Number(-900, 1500), random.Number(-700, 1200)},
                       i % 2 == 0 ? std::optional(random.Number(5, 40)) : std::nullopt);
    const Eigen::Matrix3d jacobian = PointResidualJacobian(camera, measurement, point);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d slope = (PointResidual(camera, measurement, point + step) -
                                     PointResidual(camera, measurement, point - step)) /
                                    (2.0 * kStep);
      EXPECT_LT((slope - jacobian.col(axis)).norm(), 1e-4);
    }
    const PointLinearization linear(camera, measurement, point);
    const Eigen::Vector3d residual = PointResidual(camera, measurement, point);
    EXPECT_LT((linear.residual - residual).norm(), 1e-9 * (1.0 + residual.norm()));
    EXPECT_LT((linear.Times(Eigen::Matrix3d::Identity()) - jacobian).norm(), 1e-9);
    EXPECT_LT((linear.Gradient() - jacobian.transpose() * residual).norm(),
              1e-9 * (1.0 + residual.norm()) * jacobian.norm());
    EXPECT_LT((linear.Hessian() - jacobian.transpose() * jacobian).norm(),
              1e-9 * jacobian.squaredNorm());
  }
}

const PinholeCamera kStereoCamera{.fx = 500.0, .fy = 510.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};
const Eigen::Vector3d kPoint(0.3, -0.2, 1.7);
const Eigen::Vector2d kPixel(401.0, 182.0);
constexpr double kDisparity = 22.0;
constexpr double kSigma = 1.44;

// The errors of the left column, the row and the right column, px.
Eigen::Vector3d ErrorsAt(const Eigen::Vector3d& point) {
  const Eigen::Vector3d projected = ProjectRgbd(kStereoCamera, point);
  return {projected.x() - kPixel.x(), projected.y() - kPixel.y(),
          (projected.x() - projected.z()) - (kPixel.x() - kDisparity)};
}

TEST(RightColumn, TheSquaredErrorIsThatOfBothColumnsAndTheRow) {
  const PointMeasurement measurement = MeasureRightColumn(kPixel, kSigma, kDisparity);
  EXPECT_TRUE(measurement.IsValid());
  EXPECT_NEAR(PointChi2(kStereoCamera, measurement, kPoint),
              ErrorsAt(kPoint).squaredNorm() / (kSigma * kSigma), 1e-9);
  EXPECT_EQ(measurement.degrees_of_freedom(), 3u);
}

TEST(RightColumn, WithoutDepthOnlyThePixelCounts) {
  const PointMeasurement measurement = MeasureRightColumn(kPixel, kSigma, std::nullopt);
  EXPECT_NEAR(PointChi2(kStereoCamera, measurement, kPoint),
              ErrorsAt(kPoint).head<2>().squaredNorm() / (kSigma * kSigma), 1e-9);
  EXPECT_EQ(measurement.degrees_of_freedom(), 2u);
}

TEST(RightColumn, BothFormsOfTheDerivativeAreThoseOfTheResidual) {
  const PointMeasurement measurement = MeasureRightColumn(kPixel, kSigma, kDisparity);
  const Eigen::Matrix3d jacobian = PointResidualJacobian(kStereoCamera, measurement, kPoint);
  constexpr double kStep = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d numeric = (PointResidual(kStereoCamera, measurement, kPoint + step) -
                                     PointResidual(kStereoCamera, measurement, kPoint - step)) /
                                    (2.0 * kStep);
    EXPECT_TRUE(jacobian.col(axis).isApprox(numeric, 1e-6)) << axis;
  }
  const PointLinearization linear(kStereoCamera, measurement, kPoint);
  EXPECT_TRUE(linear.residual.isApprox(PointResidual(kStereoCamera, measurement, kPoint), 1e-9));
  EXPECT_TRUE(linear.Times(Eigen::Matrix3d::Identity()).isApprox(jacobian, 1e-9));
  EXPECT_TRUE(linear.Hessian().isApprox(jacobian.transpose() * jacobian, 1e-9));
}

TEST(RightColumn, TheOptionsChooseTheModel) {
  DepthErrorOptions options;
  options.model = DepthErrorModel::kRightColumn;
  options.pixel_sigma = 1.0;
  const PointMeasurement measurement =
      PointMeasurement::Create(kPixel, kSigma, kDisparity, options);
  EXPECT_EQ(measurement.coupling, 0.5);
  EXPECT_NEAR(PointChi2(kStereoCamera, measurement, kPoint),
              ErrorsAt(kPoint).squaredNorm() / (kSigma * kSigma), 1e-9);
}

}  // namespace

}  // namespace hullslam

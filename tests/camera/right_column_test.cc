// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/right_column.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

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

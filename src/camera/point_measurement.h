// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>

#include "hullslam/camera/depth.h"
#include "hullslam/camera/pinhole.h"
#include "util/statistics.h"

// The measurement of a point by a keypoint, with or without depth, and its error. A depth z is
// converted to the disparity bf / z of a virtual stereo pair, because the disparity of a
// structured-light sensor has about the same error at all distances (Khoshelham and Elberink 2012).
// Pose estimation, bundle adjustment and the creation and fusion of landmarks all use this error.
namespace hullslam {

inline constexpr double kMinDepth = 1e-3;  // m; the projection of nearer points has no meaning

// Undistorted pixel (u, v) and disparity bf / z of a point (m, camera frame, z > 0).
inline Eigen::Vector3d ProjectRgbd(const PinholeCamera& camera, const Eigen::Vector3d& point) {
  const double inverse_z = 1.0 / point.z();
  const double u = camera.fx * point.x() * inverse_z + camera.cx;
  return {u, camera.fy * point.y() * inverse_z + camera.cy, camera.bf * inverse_z};
}

// Derivative of ProjectRgbd by the point.
inline Eigen::Matrix3d ProjectRgbdJacobian(const PinholeCamera& camera,
                                           const Eigen::Vector3d& point) {
  const double inverse_z = 1.0 / point.z();
  const double fx_z = camera.fx * inverse_z;
  const double fy_z = camera.fy * inverse_z;
  const double x_z = point.x() * inverse_z;
  const double y_z = point.y() * inverse_z;
  Eigen::Matrix3d jacobian;
  jacobian << fx_z, 0.0, -fx_z * x_z,  //
      0.0, fy_z, -fy_z * y_z,          //
      0.0, 0.0, -camera.bf * inverse_z * inverse_z;
  return jacobian;
}

// The measurement of a point by a keypoint.
struct PointMeasurement {
  Eigen::Vector3d measured = Eigen::Vector3d::Zero();  // u, v, disparity; px, undistorted
  // Inverse standard deviations of the three numbers, 1 / px; 0 for an unknown disparity.
  Eigen::Vector3d inverse_sigma = Eigen::Vector3d(1.0, 1.0, 0.0);
  // The first residual is that of u - coupling * disparity. 0 unless the errors of u and disparity
  // are correlated (MeasureRightColumn).
  double coupling = 0.0;
  // The first residual is that of u - shear * v. 0 unless the errors of u and v are correlated, as
  // those of a fisheye lens are after undistortion.
  double shear = 0.0;

  // `scale` is that of the keypoint's pyramid level. No disparity where the depth is unknown.
  static PointMeasurement Create(const Eigen::Vector2d& pixel, double scale,
                                 std::optional<double> disparity, const DepthErrorOptions& options);

  // Converts the errors of u and v, which are given in the image as read, to those of the
  // undistorted image. `raw_by_undistorted` is PinholeCamera::DistortionJacobian() at the pixel.
  void TakeLens(const Eigen::Matrix2d& raw_by_undistorted);

  bool has_depth() const { return inverse_sigma.z() > 0.0; }
  // Whether all numbers are finite and the pixel has a weight.
  bool IsValid() const {
    return measured.allFinite() && inverse_sigma.allFinite() &&
           inverse_sigma.head<2>().minCoeff() > 0.0 && inverse_sigma.z() >= 0.0;
  }
  // The number of residuals: two for the pixel, and one for the disparity if it is known.
  size_t degrees_of_freedom() const { return has_depth() ? 3 : 2; }
};

// (du - coupling * d disparity - shear * dv, dv, d disparity) in standard deviations, projected
// minus measured, of a point (m, camera frame) at least kMinDepth in front of the camera. The third
// is 0 where the depth is unknown.
inline Eigen::Vector3d PointResidual(const PinholeCamera& camera,
                                     const PointMeasurement& measurement,
                                     const Eigen::Vector3d& point) {
  Eigen::Vector3d error = ProjectRgbd(camera, point) - measurement.measured;
  error.x() -= measurement.coupling * error.z();
  error.x() -= measurement.shear * error.y();
  return measurement.inverse_sigma.cwiseProduct(error);
}

// Derivative of PointResidual by the point.
inline Eigen::Matrix3d PointResidualJacobian(const PinholeCamera& camera,
                                             const PointMeasurement& measurement,
                                             const Eigen::Vector3d& point) {
  Eigen::Matrix3d jacobian = ProjectRgbdJacobian(camera, point);
  jacobian(0, 2) -= measurement.coupling * jacobian(2, 2);
  jacobian.row(0) -= measurement.shear * jacobian.row(1);
  return measurement.inverse_sigma.asDiagonal() * jacobian;
}

// PointResidual and its derivative without the zeros of the derivative, for inner loops, in
// which multiplying by zeros would take time:
//   du by (x, y, z) is (u_by_x, u_by_y, u_by_z), dv is (0, v_by_y, v_by_z), d disparity (0, 0,
//   d_by_z).
struct PointLinearization {
  PointLinearization(const PinholeCamera& camera, const PointMeasurement& measurement,
                     const Eigen::Vector3d& point) {
    const double inverse_z = 1.0 / point.z();
    const Eigen::Vector3d& weight = measurement.inverse_sigma;
    u_by_x = weight.x() * camera.fx * inverse_z;
    v_by_y = weight.y() * camera.fy * inverse_z;
    v_by_z = -v_by_y * point.y() * inverse_z;
    const double disparity = camera.bf * inverse_z;
    const double coupling = weight.x() * measurement.coupling;
    u_by_z = -u_by_x * point.x() * inverse_z + coupling * disparity * inverse_z;
    d_by_z = -weight.z() * disparity * inverse_z;
    residual = {u_by_x * point.x() + weight.x() * (camera.cx - measurement.measured.x()) -
                    coupling * (disparity - measurement.measured.z()),
                v_by_y * point.y() + weight.y() * (camera.cy - measurement.measured.y()),
                weight.z() * (disparity - measurement.measured.z())};
    if (measurement.shear != 0.0) {
      const double shear = measurement.shear * weight.x() / weight.y();
      u_by_y = -shear * v_by_y;
      u_by_z -= shear * v_by_z;
      residual.x() -= shear * residual.y();
    }
  }

  // The derivative of the residual by something that moves the point by `point_by` (3 x N).
  template <typename Derived>
  Eigen::Matrix<double, 3, Derived::ColsAtCompileTime> Times(
      const Eigen::MatrixBase<Derived>& point_by) const {
    Eigen::Matrix<double, 3, Derived::ColsAtCompileTime> product;
    product.row(0) = u_by_x * point_by.row(0) + u_by_z * point_by.row(2);
    product.row(1) = v_by_y * point_by.row(1) + v_by_z * point_by.row(2);
    product.row(2) = d_by_z * point_by.row(2);
    if (u_by_y != 0.0) {
      product.row(0) += u_by_y * point_by.row(1);
    }
    return product;
  }

  // The transposed derivative times `residual`.
  Eigen::Vector3d Gradient() const {
    return {u_by_x * residual.x(), v_by_y * residual.y() + u_by_y * residual.x(),
            u_by_z * residual.x() + v_by_z * residual.y() + d_by_z * residual.z()};
  }

  // The transposed derivative times the derivative.
  Eigen::Matrix3d Hessian() const {
    Eigen::Matrix3d hessian;
    hessian << u_by_x * u_by_x, 0.0, u_by_x * u_by_z,  //
        0.0, v_by_y * v_by_y, v_by_y * v_by_z,         //
        u_by_x * u_by_z, v_by_y * v_by_z, u_by_z * u_by_z + v_by_z * v_by_z + d_by_z * d_by_z;
    if (u_by_y != 0.0) {
      hessian(0, 1) = hessian(1, 0) = u_by_x * u_by_y;
      hessian(1, 1) += u_by_y * u_by_y;
      hessian(1, 2) += u_by_y * u_by_z;
      hessian(2, 1) += u_by_y * u_by_z;
    }
    return hessian;
  }

  Eigen::Vector3d residual;
  double u_by_x = 0.0;
  double u_by_y = 0.0;  // 0 without shear
  double u_by_z = 0.0;
  double v_by_y = 0.0;
  double v_by_z = 0.0;
  double d_by_z = 0.0;
};

// Squared norm of PointResidual; infinite for a point nearer than kMinDepth or behind the camera.
inline double PointChi2(const PinholeCamera& camera, const PointMeasurement& measurement,
                        const Eigen::Vector3d& point) {
  return point.z() < kMinDepth ? std::numeric_limits<double>::infinity()
                               : PointResidual(camera, measurement, point).squaredNorm();
}

// The bound on PointChi2 above which the measurement is an outlier: the 95 % quantile for its
// degrees of freedom.
inline double OutlierBound(const PointMeasurement& measurement) {
  return Chi2Bound(measurement.degrees_of_freedom());
}

// Whether PointChi2 is within OutlierBound.
inline bool IsInlier(const PinholeCamera& camera, const PointMeasurement& measurement,
                     const Eigen::Vector3d& point) {
  return PointChi2(camera, measurement, point) <= OutlierBound(measurement);
}

// The depth error model `right_column` (Mur-Artal and Tardos 2017, section III.A): a keypoint with
// depth stands for the three columns and rows (u, v, u_r) of a stereo camera, u_r = u - disparity,
// whose errors are independent and have the same `sigma` (px), which grows with the level of the
// keypoint. So the error of u is part of the error of the depth. With e = du, d = d disparity,
//   e^2 + (e - d)^2 = 2 (e - d / 2)^2 + d^2 / 2,
// so the squared norm of PointResidual is that of the three errors over sigma if the residual of u
// is that of u - disparity / 2 with the sigma sigma / sqrt(2), and that of the disparity has the
// sigma sqrt(2) sigma. Without disparity, only u and v count.
PointMeasurement MeasureRightColumn(const Eigen::Vector2d& pixel, double sigma,
                                    std::optional<double> disparity);

// A landmark found in the image.
struct PoseObservation {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // m, world frame
  PointMeasurement measurement;
};

}  // namespace hullslam

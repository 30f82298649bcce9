// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/raw_residual.h"

#include <limits>

#include "camera/point_measurement.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {
namespace {

constexpr double kDifference = 1e-2;  // steps of a parameter

}  // namespace

Eigen::Vector3d RawResidual::At(const CameraModel& model, const PointVelocity& velocity,
                                const CalibrationObservation& seen,
                                const Eigen::Vector3d& point) const {
  const Eigen::Vector3d moved = MovedPoint(point, velocity, model.ExposureOf(seen.raw));
  if (moved.z() < kMinDepth) {
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  }
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  residual.head<2>() = (model.camera.Distort(model.camera.Project(moved)) - seen.raw) / seen.sigma;
  if (seen.disparity > 0.0) {
    const double expected =
        model.camera.bf / (model.depth_scale * moved.z()) + model.disparity_offset;
    residual.z() = (expected - seen.disparity) / disparity_sigma;
  }
  return residual;
}

Eigen::Matrix3d RawResidual::ByPoint(const CameraModel& model, const PointVelocity& velocity,
                                     const CalibrationObservation& seen,
                                     const Eigen::Vector3d& point) const {
  const double seconds = model.ExposureOf(seen.raw);
  const Eigen::Vector3d moved = MovedPoint(point, velocity, seconds);
  const Eigen::Matrix3d turn = Skew(velocity.angular);
  const Eigen::Matrix3d moved_by_point =
      Eigen::Matrix3d::Identity() + seconds * turn + 0.5 * seconds * seconds * turn * turn;
  const Eigen::Matrix3d projected = ProjectRgbdJacobian(model.camera, moved);
  Eigen::Matrix3d derivative = Eigen::Matrix3d::Zero();
  derivative.topRows<2>() = model.camera.DistortionJacobian(model.camera.Project(moved)) *
                            projected.topRows<2>() / seen.sigma;
  if (seen.disparity > 0.0) {
    derivative.row(2) = projected.row(2) / (model.depth_scale * disparity_sigma);
  }
  return derivative * moved_by_point;
}

ByCameraParameters::ByCameraParameters(const CameraModel& model,
                                       std::span<const CameraParameter> parameters) {
  for (const CameraParameter& parameter : parameters) {
    parameter.Move(-kDifference, below_.emplace_back(model));
    parameter.Move(kDifference, above_.emplace_back(model));
  }
}

Eigen::Matrix<double, 3, Eigen::Dynamic> ByCameraParameters::Of(
    const RawResidual& residual, const PointVelocity& velocity, const CalibrationObservation& seen,
    const Eigen::Vector3d& point) const {
  Eigen::Matrix<double, 3, Eigen::Dynamic> derivative(3, static_cast<Eigen::Index>(above_.size()));
  for (size_t i = 0; i < above_.size(); ++i) {
    derivative.col(static_cast<Eigen::Index>(i)) = (residual.At(above_[i], velocity, seen, point) -
                                                    residual.At(below_[i], velocity, seen, point)) /
                                                   (2.0 * kDifference);
  }
  return derivative;
}

}  // namespace hullslam

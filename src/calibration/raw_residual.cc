// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/raw_residual.h"

#include <limits>

#include "camera/point_measurement.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {
namespace {

constexpr double kDifference = 1e-2;  // steps of a parameter

// When and from where the depth of a point was measured.
struct DepthView {
  double seconds = 0.0;  // after the exposure of the middle of the image
  Eigen::Matrix3d turn;  // depth_from_colour
  Eigen::Vector3d shift;

  Eigen::Vector3d InView(const PointVelocity& velocity, const Eigen::Vector3d& point) const {
    return turn * MovedPoint(point, velocity, seconds) + shift;
  }
};

DepthView DepthViewOf(const CameraModel& model, const CalibrationObservation& seen,
                      const Eigen::Matrix<double, 6, 1>& known_depth_pose) {
  const Eigen::Matrix<double, 6, 1> pose = model.depth_pose - known_depth_pose;
  return {.seconds = model.ExposureOf(seen.raw) + seen.depth_delay + model.depth_time,
          .turn = ExpSo3(pose.head<3>()).toRotationMatrix(),
          .shift = pose.tail<3>()};
}

// The derivative of MovedPoint by the point.
Eigen::Matrix3d ByStart(const PointVelocity& velocity, double seconds) {
  const Eigen::Matrix3d turn = Skew(velocity.angular);
  return Eigen::Matrix3d::Identity() + seconds * turn + 0.5 * seconds * seconds * turn * turn;
}

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
    const Eigen::Vector3d deep = DepthViewOf(model, seen, known_depth_pose).InView(velocity, point);
    if (deep.z() < kMinDepth) {
      return Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    }
    const double expected =
        model.camera.bf / (model.depth_scale * deep.z()) + model.disparity_offset +
        seen.slope.dot(model.camera.Project(moved) - model.camera.Project(deep));
    residual.z() = (expected - seen.disparity) / disparity_sigma;
  }
  return residual;
}

Eigen::Matrix3d RawResidual::ByPoint(const CameraModel& model, const PointVelocity& velocity,
                                     const CalibrationObservation& seen,
                                     const Eigen::Vector3d& point) const {
  const double seconds = model.ExposureOf(seen.raw);
  const Eigen::Vector3d moved = MovedPoint(point, velocity, seconds);
  const Eigen::Matrix3d projected = ProjectRgbdJacobian(model.camera, moved);
  const Eigen::Matrix<double, 2, 3> pixel_by_point =
      projected.topRows<2>() * ByStart(velocity, seconds);
  Eigen::Matrix3d derivative = Eigen::Matrix3d::Zero();
  derivative.topRows<2>() =
      model.camera.DistortionJacobian(model.camera.Project(moved)) * pixel_by_point / seen.sigma;
  if (seen.disparity > 0.0) {
    const DepthView view = DepthViewOf(model, seen, known_depth_pose);
    const Eigen::Matrix3d deep = ProjectRgbdJacobian(model.camera, view.InView(velocity, point)) *
                                 view.turn * ByStart(velocity, view.seconds);
    derivative.row(2) = (deep.row(2) / model.depth_scale +
                         seen.slope.transpose() * (pixel_by_point - deep.topRows<2>())) /
                        disparity_sigma;
  }
  return derivative;
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/quadric_in_camera.h"

#include <Eigen/Geometry>
#include <cmath>

#include "camera/point_measurement.h"
#include "costs/manifolds.h"

namespace hullslam {

QuadricInCamera::QuadricInCamera(double const* const* parameters) {
  const Rigid3 cam_from_world = FromBlock(parameters[0]);
  const Rigid3 world_from_object = FromBlock(parameters[1]);
  cam_from_world_ = cam_from_world.rotation.toRotationMatrix();
  cam_from_object_ = cam_from_world_ * world_from_object.rotation.toRotationMatrix();
  object_in_world_ = world_from_object.translation;
  half_axes_ = Eigen::Map<const Eigen::Array3d>(parameters[2]).exp();
  center_ = cam_from_world_ * object_in_world_ + cam_from_world.translation;
  axes_ = cam_from_object_ * half_axes_.asDiagonal();
  square_.noalias() = axes_ * axes_.transpose();
}

bool QuadricInCamera::IsInFront() const {
  // Also false for NaN.
  return center_.z() - std::sqrt(square_(2, 2)) > kMinDepth && center_.allFinite() &&
         square_.allFinite();
}

// The chain rule, with the derivatives g with respect to turn and shift. A change (omega, v) of
// cam_from_world turns the object by omega and shifts it by omega x center + v. A change (omega, v)
// of world_from_object turns it by R omega and shifts it by R (omega x object + v). The code uses
// that g . (omega x x) = omega . (x x g).
void QuadricInCamera::WriteRow(int row, const ByObjectInCamera& derivative,
                               double** jacobians) const {
  const Eigen::Vector3d by_turn = derivative.segment<3>(0).transpose();
  const Eigen::Vector3d by_shift = derivative.segment<3>(3).transpose();
  if (jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 7, 1>> by_camera(jacobians[0] + 7 * row);
    by_camera << by_turn + center_.cross(by_shift), by_shift, 0.0;
  }
  if (jacobians[1] != nullptr) {
    const Eigen::Vector3d by_world_shift = cam_from_world_.transpose() * by_shift;
    Eigen::Map<Eigen::Matrix<double, 7, 1>> by_object(jacobians[1] + 7 * row);
    by_object << cam_from_world_.transpose() * by_turn + object_in_world_.cross(by_world_shift),
        by_world_shift, 0.0;
  }
  if (jacobians[2] != nullptr) {
    Eigen::Map<Eigen::Vector3d> by_log_axes(jacobians[2] + 3 * row);
    by_log_axes = derivative.segment<3>(6).transpose();
  }
}

ObjectCost::ObjectCost(size_t residuals) {
  set_num_residuals(static_cast<int>(residuals));
  *mutable_parameter_block_sizes() = {7, 7, 3};
}

}  // namespace hullslam

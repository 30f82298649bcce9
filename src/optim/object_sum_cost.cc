// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/object_sum_cost.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "optim/square_root_form.h"

namespace hullslam::internal {
namespace {

constexpr int kPose = 6;    // parameters of a pose
constexpr int kObject = 9;  // and of an object: its pose and its half axes

template <int kColumns>
using Rows = Eigen::Matrix<double, Eigen::Dynamic, kColumns, Eigen::RowMajor>;

}  // namespace

// The parameters are those of a moving camera, if there is one, followed by those of the object.
struct ObjectSumCost::NormalEquations {
  double squared_norm = 0.0;
  Eigen::MatrixXd hessian;  // lower half
  Eigen::VectorXd gradient;
};

ObjectSumCost::ObjectSumCost(Camera camera) : camera_(camera) {
  if (camera_ == Camera::kMoving) {
    *mutable_parameter_block_sizes() = {7, 7, 3};
    set_num_residuals(kPose + kObject + 1);
  } else {
    *mutable_parameter_block_sizes() = {7, 3};
    set_num_residuals(kObject + 1);
  }
}

void ObjectSumCost::Add(std::unique_ptr<ceres::CostFunction> cost,
                        const std::optional<PoseBlock>& fixed_camera) {
  parts_.push_back({std::move(cost), fixed_camera});
}

bool ObjectSumCost::AddTo(NormalEquations& sum, const Part& part, double const* const* parameters,
                          bool with_derivatives) const {
  const bool is_prior = part.cost->parameter_block_sizes().size() == 2;
  const double* const* const object = parameters + (camera_ == Camera::kMoving ? 1 : 0);
  const double* const camera = part.fixed_camera ? part.fixed_camera->data() : parameters[0];
  const double* const all[] = {camera, object[0], object[1]};
  const double* const* const taken = is_prior ? all + 1 : all;
  const int rows = part.cost->num_residuals();
  Eigen::VectorXd residuals(rows);
  if (!with_derivatives) {
    const bool is_defined = part.cost->Evaluate(taken, residuals.data(), nullptr);
    sum.squared_norm += residuals.squaredNorm();
    return is_defined;
  }
  const bool has_camera = !is_prior && !part.fixed_camera;
  Rows<7> by_camera(has_camera ? rows : 0, 7);
  Rows<7> by_pose(rows, 7);
  Rows<3> by_axes(rows, 3);
  double* blocks[] = {has_camera ? by_camera.data() : nullptr, by_pose.data(), by_axes.data()};
  if (!part.cost->Evaluate(taken, residuals.data(), is_prior ? blocks + 1 : blocks)) {
    return false;
  }
  sum.squared_norm += residuals.squaredNorm();
  const Eigen::Index size = sum.gradient.size();
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, size);
  if (has_camera) {
    jacobian.leftCols<kPose>() = by_camera.leftCols<kPose>();
  }
  jacobian.middleCols<kPose>(size - kObject) = by_pose.leftCols<kPose>();
  jacobian.rightCols<3>() = by_axes;
  sum.hessian.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.transpose());
  sum.gradient.noalias() += jacobian.transpose() * residuals;
  return true;
}

void ObjectSumCost::LeaveOutUndefined() {
  if (undefined_) {
    const auto undefined = parts_.begin() + static_cast<std::ptrdiff_t>(*undefined_);
    left_out_.push_back(std::move(*undefined));
    parts_.erase(undefined);
    undefined_.reset();
  }
}

bool ObjectSumCost::AreLeftOutDefined(double const* const* parameters) const {
  NormalEquations unused;
  return std::all_of(left_out_.begin(), left_out_.end(),
                     [&](const Part& part) { return AddTo(unused, part, parameters, false); });
}

bool ObjectSumCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  const Eigen::Index size = num_residuals() - 1;
  NormalEquations sum;
  sum.hessian.setZero(size, size);
  sum.gradient.setZero(size);
  undefined_.reset();
  for (size_t i = 0; i < parts_.size(); ++i) {
    if (!AddTo(sum, parts_[i], parameters, jacobians != nullptr)) {
      undefined_ = i;
      return false;
    }
  }
  Eigen::Map<Eigen::VectorXd> values(residuals, size + 1);
  values.setZero();
  if (jacobians == nullptr) {
    values[size] = std::sqrt(sum.squared_norm);
    return true;
  }
  SquareRootForm<Eigen::Dynamic> form;
  if (!form.Compute(sum.hessian, sum.gradient)) {
    return false;
  }
  values << form.residual(), form.LastResidual(sum.squared_norm);
  const Eigen::MatrixXd jacobian = form.jacobian();
  Eigen::Index column = 0;
  for (size_t i = 0; i < parameter_block_sizes().size(); ++i) {
    const int width = parameter_block_sizes()[i];
    const int parameters_of_block = std::min(width, kPose);
    if (jacobians[i] != nullptr) {
      Eigen::Map<Rows<Eigen::Dynamic>> block(jacobians[i], size + 1, width);
      block.setZero();
      block.topLeftCorner(size, parameters_of_block) =
          jacobian.middleCols(column, parameters_of_block);
    }
    column += parameters_of_block;
  }
  return true;
}

}  // namespace hullslam::internal

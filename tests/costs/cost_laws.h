// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>
#include <ceres/gradient_checker.h>
#include <ceres/sized_cost_function.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <vector>

#include "costs/manifolds.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The residual of a cost with the parameters (PoseBlock, point); zero if it is not defined.
template <int kRows>
Eigen::Matrix<double, kRows, 1> ResidualOf(const ceres::CostFunction& cost,
                                           const Rigid3& cam_from_world,
                                           const Eigen::Vector3d& point) {
  const PoseBlock pose = ToBlock(cam_from_world);
  const double* parameters[] = {pose.data(), point.data()};
  Eigen::Matrix<double, kRows, 1> residual = Eigen::Matrix<double, kRows, 1>::Zero();
  EXPECT_TRUE(cost.Evaluate(parameters, residual.data(), nullptr));
  return residual;
}

// Turns a cost on (PoseBlock, point) into a cost on (delta, point), where delta are the six numbers
// of the manifold's Plus. ceres::GradientChecker needs this, because with a manifold it would
// differentiate with respect to the block's seven numbers, while our costs write derivatives with
// respect to delta. The derivative is only valid at delta = 0.
template <int kRows>
class AtPose final : public ceres::SizedCostFunction<kRows, 6, 3> {
 public:
  AtPose(const ceres::CostFunction& cost, const Rigid3& cam_from_world)
      : cost_(cost), pose_(ToBlock(cam_from_world)) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    PoseBlock moved;
    PoseManifold().Plus(pose_.data(), parameters[0], moved.data());
    const double* inner[] = {moved.data(), parameters[1]};
    if (jacobians == nullptr) {
      return cost_.Evaluate(inner, residuals, nullptr);
    }
    Eigen::Matrix<double, kRows, 7, Eigen::RowMajor> by_pose;
    double* inner_jacobians[] = {by_pose.data(), jacobians[1]};
    const bool is_defined = cost_.Evaluate(inner, residuals, inner_jacobians);
    EXPECT_TRUE(by_pose.col(6).isZero(0.0));
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, kRows, 6, Eigen::RowMajor>> by_delta(jacobians[0]);
      by_delta = by_pose.template leftCols<6>();
    }
    return is_defined;
  }

 private:
  const ceres::CostFunction& cost_;
  PoseBlock pose_;
};

template <int kRows>
void ExpectTrueGradient(const ceres::CostFunction& cost, const Rigid3& cam_from_world,
                        const Eigen::Vector3d& point) {
  const AtPose<kRows> at_pose(cost, cam_from_world);
  const ceres::GradientChecker checker(&at_pose,
                                       static_cast<std::vector<const ceres::Manifold*>*>(nullptr),
                                       ceres::NumericDiffOptions());
  const std::array<double, 6> delta{};
  const double* parameters[] = {delta.data(), point.data()};
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(parameters, 1e-7, &results)) << results.error_log;
}

// Moving the world and the camera together does not change the residual.
template <int kRows>
void ExpectRigidInvariance(const ceres::CostFunction& cost, const Rigid3& cam_from_world,
                           const Eigen::Vector3d& point, const Rigid3& new_from_old_world) {
  const Rigid3 cam_from_new = cam_from_world * Inverse(new_from_old_world);
  EXPECT_LT((ResidualOf<kRows>(cost, cam_from_new, new_from_old_world * point) -
             ResidualOf<kRows>(cost, cam_from_world, point))
                .norm(),
            1e-9);
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "hullslam/geometry/sim3.h"

namespace hullslam {

// The deviation of the poses of two keyframes from a measured similarity between them. With
//   e = measured_b_from_a * a_from_world * b_from_world^-1,
// which is the identity if they agree, the residual is
//   r = inverse_sigma * (log of e's rotation (radians), e's translation, log of e's scale).
// The translation is in b's frame and unit of length. Parameters: a_from_world and b_from_world
// (SimilarityBlock, with SimilarityManifold).
class RelativeSimilarityCost final : public ceres::SizedCostFunction<7, 8, 8> {
 public:
  // `inverse_sigma`: 1 / standard deviation of the seven residuals.
  RelativeSimilarityCost(const Sim3& measured_b_from_a,
                         const Eigen::Matrix<double, 7, 1>& inverse_sigma)
      : measured_b_from_a_(measured_b_from_a), inverse_sigma_(inverse_sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Sim3 measured_b_from_a_;
  Eigen::Matrix<double, 7, 1> inverse_sigma_;
};

}  // namespace hullslam

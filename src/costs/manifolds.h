// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/manifold.h>

#include <array>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/geometry/sim3.h"

namespace hullslam {

// A Rigid3 as a parameter block: qx qy qz qw tx ty tz.
using PoseBlock = std::array<double, 7>;
PoseBlock ToBlock(const Rigid3& pose);
Rigid3 FromBlock(const double* block);

// The manifold of a PoseBlock. Plus is Retract with three numbers for the rotation, followed by
// three for the translation.
//
// Costs on such a block write their derivative with respect to these six numbers into the first six
// columns of the block's Jacobian, and zero into the seventh. PlusJacobian is [I; 0] to match. So
// no residual has to compute a derivative with respect to a quaternion.
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

// A Sim3 as a parameter block: qx qy qz qw tx ty tz scale.
using SimilarityBlock = std::array<double, 8>;
SimilarityBlock ToBlock(const Sim3& similarity);
Sim3 SimilarityFromBlock(const double* block);

// The manifold of a SimilarityBlock. Plus is Retract with the seven numbers rotation, translation,
// logarithm of the scale; with a fixed scale, with the first six of them.
//
// As with PoseManifold, costs write their derivative with respect to the seven numbers into the
// first seven columns of the block's Jacobian, and zero into the eighth.
class SimilarityManifold final : public ceres::Manifold {
 public:
  explicit SimilarityManifold(bool fix_scale) : tangent_size_(fix_scale ? 6 : 7) {}

  int AmbientSize() const override { return 8; }
  int TangentSize() const override { return tangent_size_; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;

 private:
  int tangent_size_;
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "costs/manifolds.h"

namespace hullslam::internal {

// The sum of several costs on one object, as one cost with few residuals. Ceres sees 16 residuals
// per moving observation, whatever the number of lines.
//
// Let the costs have the residuals r_1 ... r_n and the Jacobians J_1 ... J_n with respect to the
// same parameters: the six of the camera's pose, if it moves, and the nine of the object. The sum
// cost is
//   F = 1/2 sum_k |r_k|^2.
// A Gauss-Newton step on F only needs the normal equations
//   H = sum_k J_k^T J_k,   g = sum_k J_k^T r_k.
// SquareRootForm factorises them as H = L L^T and returns as many residuals as there are
// parameters, r = L^-1 g, with the Jacobian J = L^T, so that J^T J = H and J^T r = g. One more
// residual with zero derivative,
//   sqrt(sum_k |r_k|^2 - |r|^2),
// makes half of the squared norm of all residuals equal to F. So Ceres takes the same steps and
// sees the same cost as with the single residuals, but multiplies much smaller matrices. An
// observation with a moving camera has 6 + 9 + 1 = 16 residuals. The prior and all observations
// from fixed cameras are one cost with 9 + 1 = 10 residuals.
class ObjectSumCost final : public ceres::CostFunction {
 public:
  // The camera that the cost depends on besides the object, if any.
  enum class Camera { kMoving, kNone };

  // The parameter blocks are the pose of the camera (kMoving only), the pose of the object, both
  // with PoseManifold, and the logarithms of its half axes.
  explicit ObjectSumCost(Camera camera);

  // Adds a cost with the parameter blocks of QuadricInCamera, evaluated at `fixed_camera` if that
  // is given, otherwise at the pose of the moving camera; or one on the pose and half axes of the
  // object.
  void Add(std::unique_ptr<ceres::CostFunction> cost,
           const std::optional<PoseBlock>& fixed_camera = std::nullopt);
  size_t size() const { return parts_.size(); }  // costs in the sum

  // Whether a cost was undefined at the last evaluation.
  bool HasUndefined() const { return undefined_.has_value(); }
  // Takes the undefined cost, if there is one, out of the sum.
  void LeaveOutUndefined();
  // Whether the costs that were left out are defined at these parameters.
  bool AreLeftOutDefined(double const* const* parameters) const;

  // Returns false if one of the costs is undefined.
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  struct Part {
    std::unique_ptr<ceres::CostFunction> cost;
    std::optional<PoseBlock> fixed_camera;
  };
  struct NormalEquations;

  bool AddTo(NormalEquations& sum, const Part& part, double const* const* parameters,
             bool with_derivatives) const;

  Camera camera_;
  std::vector<Part> parts_;
  std::vector<Part> left_out_;
  mutable std::optional<size_t> undefined_;  // index into parts_
};

}  // namespace hullslam::internal

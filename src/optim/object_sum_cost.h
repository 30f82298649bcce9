// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/cost_function.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "costs/pose_manifold.h"

namespace hullslam::internal {

// The sum of costs on one object as one cost with few residuals: the SquareRootForm of the sum of
// their normal equations, and one residual more that makes the squared norm the true one. A view
// of an object is then 16 rows to Ceres, however many lines its hull has, and all views from
// keyframes that do not move are ten rows together.
class ObjectSumCost final : public ceres::CostFunction {
 public:
  // What the cost depends on, besides the object.
  enum class Camera { kMoving, kNone };

  // The parameter blocks are the pose of the camera (kMoving only), the pose of the object, both
  // with PoseManifold, and the logarithms of its half axes.
  explicit ObjectSumCost(Camera camera);

  // Adds a cost with the parameter blocks of QuadricInCamera: at the pose of the moving camera, or,
  // if it is given, always at `fixed_camera`.
  void Add(std::unique_ptr<ceres::CostFunction> cost,
           const std::optional<PoseBlock>& fixed_camera = std::nullopt);
  // Adds a cost on the pose and the half axes of the object.
  void AddPrior(std::unique_ptr<ceres::CostFunction> prior);
  size_t size() const { return parts_.size(); }  // costs in the sum

  // Whether a cost was not defined where the sum was evaluated last.
  bool HasUndefined() const { return undefined_.has_value(); }
  // Takes this cost out of the sum.
  void LeaveOutUndefined();
  // Whether the costs that were left out are defined at these parameters.
  bool AreLeftOutDefined(double const* const* parameters) const;

  // False where one of the costs is not defined.
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
  mutable std::optional<size_t> undefined_;  // place among the parts
};

}  // namespace hullslam::internal

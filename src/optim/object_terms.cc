// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/object_terms.h"

#include <algorithm>
#include <limits>

#include "objects/constraint/object_constraint.h"

namespace hullslam::internal {

ObjectTerms::ObjectTerms(const PinholeCamera& camera, const Rigid3& start,
                         std::span<const PoseObject> objects, const ObjectPoseOptions& options)
    : terms_(objects.size()), outlier_(options.constraint.loss_scale) {
  int most_rows = 0;
  for (size_t i = 0; i < objects.size(); ++i) {
    const PoseObject& object = objects[i];
    const ResolvedObservation observation{KeyframeId(), start, object.detection};
    Term& term = terms_[i];
    term.cost = MakeObjectConstraint(camera, observation, object.lines, object.ellipsoid,
                                     object.misfit_px, options.constraint, object.right_lines)
                    .silhouette;
    if (term.cost == nullptr) {
      continue;
    }
    term.world_from_object = ToBlock(object.ellipsoid.world_from_object);
    term.log_axes = object.ellipsoid.half_axes.array().log();
    term.is_used = true;
    most_rows = std::max(most_rows, term.cost->num_residuals());
  }
  residuals_.resize(most_rows);
  by_pose_.resize(most_rows, 7);
}

bool ObjectTerms::Evaluate(const Term& term, const PoseBlock& pose, bool with_derivative) const {
  const double* parameters[] = {pose.data(), term.world_from_object.data(), term.log_axes.data()};
  double* jacobians[] = {by_pose_.data(), nullptr, nullptr};
  return term.cost->plain().Evaluate(parameters, residuals_.data(),
                                     with_derivative ? jacobians : nullptr);
}

double ObjectTerms::Cost(const Rigid3& pose) const {
  const PoseBlock block = ToBlock(pose);
  double cost = 0.0;
  for (const Term& term : terms_) {
    if (!term.is_used) {
      continue;
    }
    if (!Evaluate(term, block, false)) {
      return std::numeric_limits<double>::infinity();
    }
    for (int i = 0; i < term.cost->num_residuals(); ++i) {
      cost += term.cost->CostOf(residuals_[i]);
    }
  }
  return cost;
}

void ObjectTerms::Linearize(const Rigid3& pose, Matrix6d& hessian, Vector6d& gradient) const {
  const PoseBlock block = ToBlock(pose);
  for (const Term& term : terms_) {
    if (!term.is_used || !Evaluate(term, block, true)) {
      continue;
    }
    for (int i = 0; i < term.cost->num_residuals(); ++i) {
      const double weight = term.cost->WeightOf(residuals_[i]);
      const Vector6d by_pose = by_pose_.row(i).head<6>().transpose();
      hessian.noalias() += weight * by_pose * by_pose.transpose();
      gradient += weight * residuals_[i] * by_pose;
    }
  }
}

void ObjectTerms::Choose(const Rigid3& pose) {
  const PoseBlock block = ToBlock(pose);
  for (Term& term : terms_) {
    term.is_used = term.cost != nullptr && Evaluate(term, block, false);
    if (term.is_used) {
      const auto rows = term.cost->num_residuals();
      const auto inliers = (residuals_.head(rows).array().abs() <= outlier_).count();
      term.is_used = 2 * inliers > rows;
    }
  }
}

int ObjectTerms::used() const {
  return static_cast<int>(
      std::count_if(terms_.begin(), terms_.end(), [](const Term& term) { return term.is_used; }));
}

void ObjectTerms::Write(JointPoseResult& result) const {
  result.used_objects = used();
  result.dropped_objects = 0;
  result.object_used.clear();
  for (const Term& term : terms_) {
    result.object_used.push_back(term.is_used ? 1 : 0);
    result.dropped_objects += term.cost != nullptr && !term.is_used ? 1 : 0;
  }
}

}  // namespace hullslam::internal

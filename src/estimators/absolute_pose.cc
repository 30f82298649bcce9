// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/absolute_pose.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>

#include "estimators/determination.h"
#include "estimators/p3p.h"

namespace hullslam {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// For Ransac().
class PoseProblem {
 public:
  using Model = Rigid3;
  static constexpr size_t kSampleSize = 3;

  PoseProblem(const PinholeCamera& camera, std::span<const PoseObservation> matches)
      : camera_(camera) {
    for (size_t i = 0; i < matches.size(); ++i) {
      if (matches[i].point.allFinite() && matches[i].measurement.IsValid()) {
        matches_.push_back(matches[i]);
        indices_.push_back(i);
        inverse_bounds_.push_back(1.0 / OutlierBound(matches[i].measurement));
      }
    }
  }

  size_t size() const { return matches_.size(); }
  // The index of a match of this problem in the list that it was made from.
  size_t IndexOf(size_t match) const { return indices_[match]; }

  void Solve(const std::array<size_t, kSampleSize>& sample, std::vector<Rigid3>& models) const {
    std::array<Eigen::Vector3d, 3> rays;
    std::array<Eigen::Vector3d, 3> points;
    for (size_t i = 0; i < sample.size(); ++i) {
      const PoseObservation& match = matches_[sample[i]];
      rays[i] = camera_.Unproject(match.measurement.measured.head<2>(), 1.0);
      points[i] = match.point;
    }
    const P3pPoses poses = SolveP3p(rays, points);
    models.insert(models.end(), poses.cam_from_world.begin(),
                  poses.cam_from_world.begin() + static_cast<std::ptrdiff_t>(poses.count));
  }

  double Error(const Rigid3& cam_from_world, size_t match) const {
    return inverse_bounds_[match] *
           PointChi2(camera_, matches_[match].measurement, cam_from_world * matches_[match].point);
  }

  // A Gauss-Newton step.
  std::optional<Rigid3> Refine(const Rigid3& cam_from_world,
                               const std::vector<size_t>& inliers) const {
    Matrix6d hessian = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    for (const size_t i : inliers) {
      const Eigen::Vector3d in_cam = cam_from_world * matches_[i].point;
      const Eigen::Matrix<double, 3, 6> jacobian = JacobianAt(in_cam, i);
      hessian.noalias() += jacobian.transpose() * jacobian;
      gradient.noalias() +=
          jacobian.transpose() * PointResidual(camera_, matches_[i].measurement, in_cam);
    }
    const Vector6d step = hessian.ldlt().solve(-gradient);
    return step.allFinite() ? std::optional(Retract(cam_from_world, step)) : std::nullopt;
  }

  bool Determines(const Rigid3& cam_from_world, const std::vector<size_t>& inliers) const {
    std::vector<Matrix6d> informations;
    for (const size_t i : inliers) {
      const Eigen::Matrix<double, 3, 6> jacobian =
          JacobianAt(cam_from_world * matches_[i].point, i);
      informations.emplace_back(jacobian.transpose() * jacobian);
    }
    return internal::DetermineParameters(informations, {0, 1, 2});
  }

 private:
  // Derivative of PointResidual by the parameters of Retract.
  Eigen::Matrix<double, 3, 6> JacobianAt(const Eigen::Vector3d& in_cam, size_t match) const {
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian.rightCols<3>() = PointResidualJacobian(camera_, matches_[match].measurement, in_cam);
    jacobian.leftCols<3>() = -jacobian.rightCols<3>() * Skew(in_cam);
    return jacobian;
  }

  const PinholeCamera& camera_;
  std::vector<PoseObservation> matches_;
  std::vector<size_t> indices_;
  std::vector<double> inverse_bounds_;
};

}  // namespace

AbsolutePose EstimateAbsolutePose(const PinholeCamera& camera,
                                  std::span<const PoseObservation> matches,
                                  const RansacOptions& options) {
  const PoseProblem problem(camera, matches);
  RansacResult<Rigid3> found = Ransac(problem, options);
  if (found.ok() && !problem.Determines(found.model, found.inliers)) {
    found.failure = "the matches do not determine the rotation: nearly all points are on one line";
  }
  AbsolutePose pose{.cam_from_world = found.model,
                    .inliers = {},
                    .score = found.score,
                    .iterations = found.iterations,
                    .failure = std::move(found.failure)};
  for (const size_t match : found.inliers) {
    pose.inliers.push_back(problem.IndexOf(match));
  }
  return pose;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/joint_pose_optimization.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "camera/point_measurement.h"
#include "optim/object_terms.h"
#include "optim/pose_problem.h"

namespace hullslam {
namespace {

using internal::Matrix6d;
using internal::Vector6d;

class JointProblem {
 public:
  JointProblem(const internal::PointTerms& points, const internal::ObjectTerms& objects,
               const Rigid3& start, double distance, const ObjectPoseOptions& options)
      : points_(points), objects_(objects), world_from_start_(Inverse(start)) {
    information_ << Eigen::Vector3d::Constant(1.0 / options.prior_rotation),
        Eigen::Vector3d::Constant(1.0 / (options.prior_translation * distance));
    information_ = information_.cwiseAbs2().eval();
  }

  double Cost(const Rigid3& pose) const {
    const Vector6d motion = Motion(pose);
    return points_.Cost(pose) + objects_.Cost(pose) + motion.dot(information_.cwiseProduct(motion));
  }

  void Linearize(const Rigid3& pose, Matrix6d& hessian, Vector6d& gradient) const {
    points_.Linearize(pose, hessian, gradient);
    objects_.Linearize(pose, hessian, gradient);
    hessian.diagonal() += information_;
    gradient += information_.cwiseProduct(Motion(pose));
  }

 private:
  // The motion from the start to `pose`, in the camera frame. Linearize uses the identity as its
  // derivative. That is exact only at the start, but good enough for a weak prior.
  Vector6d Motion(const Rigid3& pose) const {
    const Rigid3 moved_from_start = pose * world_from_start_;
    Vector6d motion;
    motion << LogSo3(moved_from_start.rotation), moved_from_start.translation;
    return motion;
  }

  const internal::PointTerms& points_;
  const internal::ObjectTerms& objects_;
  Rigid3 world_from_start_;
  Vector6d information_;
};

double MeanDistance(const Rigid3& cam_from_world, std::span<const PoseObject> objects) {
  double sum = 0.0;
  for (const PoseObject& object : objects) {
    sum += (cam_from_world * object.ellipsoid.world_from_object.translation).norm();
  }
  return sum / static_cast<double>(objects.size());
}

// The Hessian of half of the cost, which is the inverse covariance, since residuals are in sigmas.
void AddInformation(const internal::PointTerms& points, const internal::ObjectTerms& objects,
                    JointPoseResult& result) {
  Vector6d gradient;
  points.Linearize(result.points.cam_from_world, result.information, gradient);
  objects.Linearize(result.points.cam_from_world, result.information, gradient);
}

bool IsConstrained(const JointPoseResult& result, const JointPoseOptions& options) {
  return result.points.inlier_count >= 3 || result.used_objects >= options.objects.min_objects;
}

}  // namespace

JointPoseResult OptimizeJointPose(const PinholeCamera& camera, const Rigid3& cam_from_world,
                                  std::span<const PoseObservation> observations,
                                  std::span<const PoseObject> objects,
                                  const JointPoseOptions& options) {
  JointPoseResult result;
  internal::ObjectTerms terms(camera, cam_from_world, objects, options.objects);
  terms.Write(result);
  if (result.used_objects == 0) {
    result.points = OptimizePose(camera, cam_from_world, observations, options.points);
    AddInformation({camera, observations, result.points.is_inlier, false}, terms, result);
    return result;
  }
  const double distance = MeanDistance(cam_from_world, objects);
  Rigid3& pose = result.points.cam_from_world;
  pose = cam_from_world;
  result.points.is_inlier.assign(observations.size(), 0);
  internal::ChooseInliers(camera, observations, internal::InlierRule::kInFront, result.points);
  for (int round = 0; round < options.points.rounds && IsConstrained(result, options); ++round) {
    const internal::PointTerms points(camera, observations, result.points.is_inlier,
                                      round < options.points.robust_rounds);
    const JointProblem problem(points, terms, cam_from_world, distance, options.objects);
    pose = internal::Minimize(problem, pose, options.points);
    const bool has_changed = internal::ChooseInliers(
        camera, observations, internal::InlierRule::kBelowBound, result.points);
    const std::vector<uint8_t> used = result.object_used;
    terms.Choose(pose);
    terms.Write(result);
    if (!has_changed && result.object_used == used) {
      break;  // as in OptimizePose
    }
  }
  if (!IsConstrained(result, options)) {
    pose = cam_from_world;
  }
  AddInformation({camera, observations, result.points.is_inlier, false}, terms, result);
  return result;
}

double CornerSigma(const PinholeCamera& camera, const Eigen::Matrix<double, 6, 6>& information,
                   double depth) {
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> factors(information);
  if (factors.info() != Eigen::Success) {
    return std::numeric_limits<double>::infinity();
  }
  double largest = 0.0;
  for (const double u : {0.0, static_cast<double>(camera.width)}) {
    for (const double v : {0.0, static_cast<double>(camera.height)}) {
      const Eigen::Vector2d corner = camera.Undistort({u, v});
      const Eigen::Vector3d point = camera.Unproject(corner, depth);
      Eigen::Matrix<double, 3, 6> point_by_step;
      point_by_step << Eigen::Matrix3d::Identity().colwise().cross(point),
          Eigen::Matrix3d::Identity();
      const Eigen::Matrix<double, 2, 6> pixel_by_step =
          camera.DistortionJacobian(corner) * ProjectRgbdJacobian(camera, point).topRows<2>() *
          point_by_step;
      // With information = L L^T, the covariance of the pixel is A^T A with A = L^-1 J^T.
      const Eigen::Matrix<double, 6, 2> whitened =
          factors.matrixL().solve(pixel_by_step.transpose());
      const Eigen::Matrix2d covariance = whitened.transpose() * whitened;
      largest = std::max(largest, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(
                                      covariance, Eigen::EigenvaluesOnly)
                                      .eigenvalues()
                                      .maxCoeff());
    }
  }
  return std::sqrt(largest);
}

}  // namespace hullslam

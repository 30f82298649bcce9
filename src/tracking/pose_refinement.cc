// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/pose_refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cstdint>
#include <utility>
#include <vector>

#include "frame/measure_point.h"
#include "optim/joint_pose_optimization.h"
#include "optim/pose_problem.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Squared Mahalanobis distance of a prior that is dropped: the 99.9 % quantile of 6 dimensions.
constexpr double kMostPriorError = 22.458;

// At the solution, the gradient g of half the cost of one quarter of the image has the covariance
// G - G H^-1 G if errors are independent and as large as assumed (G: Hessian of the quarter, H: of
// all). Then g' H^-1 g has the mean trace(A - A^2), A = H^-1 G. Errors that neighbours share (lens,
// shutter, depth) make it larger. It is the covariance for clusters (Liang and Zeger 1986).
void SumQuarters(const PinholeCamera& camera, std::span<const PoseObservation> observations,
                 const JointPoseResult& joint, PoseEstimate& estimate) {
  const Eigen::LLT<Matrix6d> factors(joint.information);
  estimate.squares = estimate.expected_squares = 0.0;
  for (int quarter = 0; quarter < 4 && factors.info() == Eigen::Success; ++quarter) {
    std::vector<uint8_t> is_inside = joint.points.is_inlier;
    for (size_t i = 0; i < observations.size(); ++i) {
      const Eigen::Vector3d& pixel = observations[i].measurement.measured;
      const int of_pixel = (pixel.x() < camera.cx ? 0 : 1) + (pixel.y() < camera.cy ? 0 : 2);
      is_inside[i] = of_pixel == quarter ? is_inside[i] : 0;
    }
    Matrix6d hessian;
    Eigen::Matrix<double, 6, 1> gradient;
    internal::PointTerms(camera, observations, is_inside, false)
        .Linearize(joint.points.cam_from_world, hessian, gradient);
    const Matrix6d share = factors.solve(hessian);
    estimate.squares += gradient.dot(factors.solve(gradient));
    estimate.expected_squares += (share - share * share).trace();
  }
}

}  // namespace

bool FusePrior(const Rigid3& expected, const Matrix6d& covariance, PoseEstimate& estimate) {
  const Matrix6d prior_information = covariance.inverse();
  const Eigen::Matrix<double, 6, 1> step = Difference(estimate.cam_from_world, expected);
  const Matrix6d both = covariance + estimate.information.inverse();
  if (!(step.dot(both.llt().solve(step)) <= kMostPriorError)) {
    return false;
  }
  estimate.information += prior_information;
  estimate.cam_from_world =
      Retract(estimate.cam_from_world, estimate.information.llt().solve(prior_information * step));
  return true;
}

PoseEstimate RefinePose(const Frame& frame, const Map& map, const TrackingContext& context,
                        std::span<const PoseObject> objects, PoseEstimate estimate) {
  std::vector<PoseObservation> observations;
  std::vector<size_t> keypoints;
  for (size_t i = 0; i < estimate.landmarks.size(); ++i) {
    if (estimate.landmarks[i].IsValid()) {
      observations.push_back(
          {.point = map.landmarks().At(estimate.landmarks[i]).position,
           .measurement = MeasurePoint(context.sensor, frame.features, static_cast<uint32_t>(i),
                                       context.sensor.depth_error)});
      keypoints.push_back(i);
    }
  }
  const JointPoseResult joint =
      OptimizeJointPose(context.sensor.camera, estimate.cam_from_world, observations, objects,
                        {.objects = context.objects.pose});
  estimate.cam_from_world = joint.points.cam_from_world;
  estimate.inliers = joint.points.inlier_count;
  estimate.used_objects = joint.used_objects;
  estimate.information = estimate.seen_information = joint.information;
  SumQuarters(context.sensor.camera, observations, joint, estimate);
  std::vector<double> depths;
  for (size_t k = 0; k < keypoints.size(); ++k) {
    if (joint.points.is_inlier[k] == 0) {
      estimate.landmarks[keypoints[k]] = LandmarkId();
    } else {
      depths.push_back((estimate.cam_from_world * observations[k].point).z());
    }
  }
  estimate.median_depth = depths.empty() ? 0.0 : Median(std::move(depths));
  estimate.corner_sigma =
      estimate.median_depth == 0.0
          ? 0.0
          : CornerSigma(context.sensor.camera, joint.information, estimate.median_depth);
  return estimate;
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/similarity_error.h"

#include <cmath>

namespace hullslam {
namespace {

// Derivative of a point of frame b by the parameters of Retract.
Eigen::Matrix<double, 3, 7> MotionOf(const Eigen::Vector3d& point_in_b) {
  Eigen::Matrix<double, 3, 7> motion;
  motion << -Skew(point_in_b), Eigen::Matrix3d::Identity(), point_in_b;
  return motion;
}

}  // namespace

SimilarityResidual SimilarityResidualInA(const PinholeCamera& camera, const SimilarityMatch& match,
                                         const TwoWaySimilarity& similarity) {
  const Sim3& a_from_b = similarity.a_from_b;
  const Eigen::Vector3d in_a = a_from_b * match.point_in_b;
  const Eigen::Matrix3d by_point_in_b = PointResidualJacobian(camera, match.measured_in_a, in_a) *
                                        (a_from_b.scale * a_from_b.rotation.toRotationMatrix());
  // The inverse of the moved similarity applies the inverse step to the point and then maps it.
  return {PointResidual(camera, match.measured_in_a, in_a),
          -by_point_in_b * MotionOf(match.point_in_b)};
}

SimilarityResidual SimilarityResidualInB(const PinholeCamera& camera, const SimilarityMatch& match,
                                         const TwoWaySimilarity& similarity) {
  const Eigen::Vector3d in_b = similarity.b_from_a * match.point_in_a;
  return {PointResidual(camera, match.measured_in_b, in_b),
          PointResidualJacobian(camera, match.measured_in_b, in_b) * MotionOf(in_b)};
}

SimilarityDepthResidual::SimilarityDepthResidual(const SimilarityMatch& match,
                                                 const TwoWaySimilarity& similarity) {
  constexpr double kSigma = 0.2;  // sigma of the logarithm of the quotient of two depths
  const Eigen::Vector3d in_b = similarity.b_from_a * match.point_in_a;
  residual = std::log(in_b.z() / match.point_in_b.z()) / kSigma;
  jacobian = MotionOf(in_b).row(2) / (kSigma * in_b.z());
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "camera/point_measurement.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/sim3.h"

namespace hullslam {

// A point of the world that two keyframes a and b see. Each keyframe has its own landmark for it.
// The positions of the two landmarks differ by the drift between the keyframes.
struct SimilarityMatch {
  Eigen::Vector3d point_in_a = Eigen::Vector3d::Zero();  // a's landmark in a's camera frame
  Eigen::Vector3d point_in_b = Eigen::Vector3d::Zero();  // b's landmark in b's camera frame
  PointMeasurement measured_in_a;                        // the keypoint in a's image
  PointMeasurement measured_in_b;
};

// A similarity and its inverse.
struct TwoWaySimilarity {
  TwoWaySimilarity() = default;
  explicit TwoWaySimilarity(const Sim3& b_from_a_in)
      : b_from_a(b_from_a_in), a_from_b(Inverse(b_from_a_in)) {}

  Sim3 b_from_a;
  Sim3 a_from_b;
};

// Squared errors of a match: of a's point in b's image and of b's point in a's image (PointChi2).
// Infinite where the point is not in front of the camera.
struct SimilarityChi2 {
  SimilarityChi2(const PinholeCamera& camera, const SimilarityMatch& match,
                 const TwoWaySimilarity& similarity)
      : in_a(PointChi2(camera, match.measured_in_a, similarity.a_from_b * match.point_in_b)),
        in_b(PointChi2(camera, match.measured_in_b, similarity.b_from_a * match.point_in_a)) {}

  double in_a;
  double in_b;
};

// The larger one of the two errors over its OutlierBound. The match is an inlier if it is at
// most 1.
inline double SimilarityError(const PinholeCamera& camera, const SimilarityMatch& match,
                              const TwoWaySimilarity& similarity) {
  const SimilarityChi2 chi2(camera, match, similarity);
  return std::max(chi2.in_a / OutlierBound(match.measured_in_a),
                  chi2.in_b / OutlierBound(match.measured_in_b));
}

// The PointResidual of a match in one of the images, and its derivative with respect to the seven
// parameters of Retract(b_from_a, delta).
struct SimilarityResidual {
  Eigen::Vector3d residual;
  Eigen::Matrix<double, 3, 7> jacobian;
};

// The residuals in a's image and in b's. The point must be in front of the camera.
SimilarityResidual SimilarityResidualInA(const PinholeCamera& camera, const SimilarityMatch& match,
                                         const TwoWaySimilarity& similarity);
SimilarityResidual SimilarityResidualInB(const PinholeCamera& camera, const SimilarityMatch& match,
                                         const TwoWaySimilarity& similarity);

// The difference of the two landmarks' depths in b's frame:
//   r = (log z(b_from_a * point_in_a) - log z(point_in_b)) / 0.2,
// with its derivative as above. If both cameras are at the same position, the reprojection errors
// do not depend on the scale, and only this residual constrains it. Triangulated depths may be
// wrong by some 10 %, so the weight is low. Both points must be in front of camera b.
struct SimilarityDepthResidual {
  SimilarityDepthResidual(const SimilarityMatch& match, const TwoWaySimilarity& similarity);

  double residual;
  Eigen::Matrix<double, 1, 7> jacobian;
};

}  // namespace hullslam

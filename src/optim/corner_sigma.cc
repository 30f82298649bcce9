// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/corner_sigma.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "camera/point_measurement.h"

namespace hullslam {

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

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hullslam::internal {

// Whether the matches of an estimate determine its first kAngles parameters (radians), and not one
// match alone does: without the match that says most, their standard deviations are still below 0.1
// rad. `informations`: for each match its part of the Hessian, J^T J with J in 1 / sigmas. This is
// false for points on a line with a single point beside it, which all agree on a wrong rotation if
// that point is an outlier.
template <int kAngles, int kSize>
bool DeterminesAngles(const std::vector<Eigen::Matrix<double, kSize, kSize>>& informations) {
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  constexpr double kMaxSigma = 0.1;  // rad
  Matrix hessian = Matrix::Zero();
  for (const Matrix& information : informations) {
    hessian += information;
  }
  const auto covariance = [](const Matrix& sum) -> Matrix {
    return sum.ldlt().solve(Matrix::Identity());
  };
  const Matrix of_all = covariance(hessian);
  size_t strongest = 0;
  double most = -1.0;
  for (size_t i = 0; i < informations.size(); ++i) {
    const double leverage = of_all.cwiseProduct(informations[i]).sum();  // trace of the product
    if (leverage > most) {
      most = leverage;
      strongest = i;
    }
  }
  if (!(most > 0.0)) {
    return false;
  }
  const Matrix of_rest = covariance(hessian - informations[strongest]);
  for (int i = 0; i < kAngles; ++i) {
    const double variance = of_rest(i, i);
    if (!(variance > 0.0 && variance < kMaxSigma * kMaxSigma)) {
      return false;
    }
  }
  return true;
}

}  // namespace hullslam::internal

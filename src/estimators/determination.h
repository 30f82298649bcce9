// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <vector>

namespace hullslam::internal {

// Whether several matches of an estimate together determine some of its parameters, which are
// angles (radians) or logarithms of scales. The standard deviations of these parameters must be
// below 0.1 even without the match that constrains them most. `informations` has for each match its
// part of the Hessian, J^T J with J in 1 / sigmas. The result is false, for example, for points on
// a line with a single point beside it: if that point is an outlier, all points agree on a wrong
// rotation.
template <int kSize>
bool DetermineParameters(const std::vector<Eigen::Matrix<double, kSize, kSize>>& informations,
                         std::initializer_list<int> parameters) {
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  constexpr double kMaxSigma = 0.1;
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
  for (const int i : parameters) {
    const double variance = of_rest(i, i);
    if (!(variance > 0.0 && variance < kMaxSigma * kMaxSigma)) {
      return false;
    }
  }
  return true;
}

}  // namespace hullslam::internal

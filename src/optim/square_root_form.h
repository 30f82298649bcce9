// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace hullslam::internal {

// Converts normal equations into residuals and their Jacobian.
//
// The solvers of Ceres minimise 1/2 |r(x)|^2 and need r and its Jacobian J. They use them only
// through the cost 1/2 |r|^2, the gradient g = J^T r and the Gauss-Newton Hessian H = J^T J. Where
// our own code sums up H, g and the squared norm N = |r|^2 directly, any residuals with the same
// three values give the same steps. The smallest such set follows from the Cholesky factor L of H =
// L L^T:
//   r' = L^-1 g,   J' = L^T
// because J'^T J' = L L^T = H and J'^T r' = L L^-1 g = g. Its squared norm is |r'|^2 = g^T H^-1 g,
// which is at most N. One more residual
//   r_last = sqrt(N - |r'|^2)
// with zero derivative makes the squared norm equal to N.
template <int kSize>
class SquareRootForm {
 public:
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  // Only the lower half of `hessian` is used. Returns false if it is not positive semidefinite or
  // not finite.
  bool Compute(const Matrix& hessian, const Vector& gradient) {
    matrix_ = hessian;
    return Factorise(gradient);
  }
  // The same for the Hessian in matrix(), which is overwritten. So a large one is in memory once.
  bool Factorise(const Vector& gradient) {
    const double largest = matrix_.diagonal().maxCoeff();
    // A small diagonal term makes the factor exist even if a parameter has no influence, or if a
    // small eigenvalue is lost in rounding.
    matrix_.diagonal() += 1e-9 * matrix_.diagonal();
    matrix_.diagonal().array() += 1e-12 * largest + 1e-30;
    const Eigen::LLT<Eigen::Ref<Matrix>> factor(matrix_);
    residual_ = gradient;
    factor.matrixL().solveInPlace(residual_);
    return factor.info() == Eigen::Success && residual_.allFinite();
  }
  Matrix& matrix() { return matrix_; }

  const Vector& residual() const { return residual_; }  // r'
  // r_last, if the squares of all residuals add up to `squared_norm`.
  double LastResidual(double squared_norm) const {
    return std::sqrt(std::max(0.0, squared_norm - residual_.squaredNorm()));
  }
  // J = L^T.
  auto jacobian() const { return matrix_.transpose().template triangularView<Eigen::Upper>(); }
  // The block of J that begins at (row, column), which must not lie below the diagonal.
  template <int kBlock>
  Eigen::Matrix<double, kBlock, kBlock> JacobianBlock(Eigen::Index row, Eigen::Index column) const {
    const Eigen::Matrix<double, kBlock, kBlock> block =
        matrix_.template block<kBlock, kBlock>(column, row).transpose();
    return row == column ? block.template triangularView<Eigen::Upper>().toDenseMatrix() : block;
  }

 private:
  Matrix matrix_;  // L in its lower half
  Vector residual_;
};

}  // namespace hullslam::internal

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace hullslam::internal {

// Normal equations as residuals r and their Jacobian J, which is what the solvers of Ceres ask for.
// With the Cholesky factor S = L L^T of the Hessian and the gradient g,
//   r = L^-1 g and J = L^T give J^T J = S and J^T r = g.
// One more residual, whose derivative is zero, makes the squared norm of all residuals what it is
// said to be.
template <int kSize>
class SquareRootForm {
 public:
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  // `hessian`: its lower half is enough. False if it is not positive semidefinite or not finite.
  bool Compute(const Matrix& hessian, const Vector& gradient) {
    Matrix held = hessian;
    // The factor would not exist if a parameter had no influence, or if rounding had eaten a small
    // eigenvalue.
    held.diagonal() += 1e-9 * hessian.diagonal();
    held.diagonal().array() += 1e-12 * hessian.diagonal().maxCoeff() + 1e-30;
    factor_.compute(held);
    residual_ = gradient;
    factor_.matrixL().solveInPlace(residual_);
    return factor_.info() == Eigen::Success && residual_.allFinite();
  }

  const Vector& residual() const { return residual_; }
  // The residual that is missing if the squares of all residuals add up to `squared_norm`.
  double LastResidual(double squared_norm) const {
    return std::sqrt(std::max(0.0, squared_norm - residual_.squaredNorm()));
  }
  // J = L^T.
  auto jacobian() const { return factor_.matrixU(); }
  // The block of J that begins at (row, column), which must not lie below the diagonal.
  template <int kBlock>
  Eigen::Matrix<double, kBlock, kBlock> JacobianBlock(Eigen::Index row, Eigen::Index column) const {
    const Eigen::Matrix<double, kBlock, kBlock> block =
        factor_.matrixLLT().template block<kBlock, kBlock>(column, row).transpose();
    return row == column ? block.template triangularView<Eigen::Upper>().toDenseMatrix() : block;
  }

 private:
  Eigen::LLT<Matrix> factor_;
  Vector residual_;
};

}  // namespace hullslam::internal

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hullslam::internal {

// A symmetric matrix of 6x6 blocks, most of which are zero, and its Cholesky factor L in the same
// memory. The result is that of SquareRootForm, but only the blocks that L needs are stored: those
// at which the matrix is not zero, and the fill-in. Where the columns i and j of L have a common
// row below both, L has a block at (j, i) too (George and Liu 1981). Only the lower half is stored.
class BlockCholesky {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;

  // The rows below the diagonal of the blocks of each column that are not zero, in any order.
  explicit BlockCholesky(std::vector<std::vector<uint32_t>> rows);

  size_t size() const { return rows_.size(); }  // columns of blocks
  // The rows below the diagonal of the blocks of L, which increase.
  const std::vector<uint32_t>& RowsOf(size_t column) const { return rows_[column]; }
  size_t block_count() const { return blocks_.size(); }
  void SetZero();
  // The block of the matrix, and of L after Factorise(). It must be one of the stored ones, and is
  // not above the diagonal.
  Block& At(size_t row, size_t column);
  const Block& At(size_t row, size_t column) const;

  // Replaces the matrix by L, with the diagonal of SquareRootForm. Returns false if it is not
  // positive semidefinite or not finite.
  bool Factorise(const Eigen::VectorXd& gradient);
  const Eigen::VectorXd& residual() const { return residual_; }  // L^-1 gradient

 private:
  std::vector<std::vector<uint32_t>> rows_;
  std::vector<size_t> begins_;  // of the columns in blocks_; the block on the diagonal is the first
  std::vector<Block> blocks_;
  Eigen::VectorXd residual_;
};

}  // namespace hullslam::internal

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

namespace hullslam::internal {

// A symmetric matrix of 6x6 blocks, most of which are zero, and its Cholesky factor L in the same
// memory, as in SquareRootForm. Only the blocks of the lower half that L needs are stored: those of
// the matrix, and the fill-in. Where two blocks of a column of L are in the rows i < j, L has a
// block at (j, i) too (George and Liu 1981).
class BlockCholesky {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;

  // The rows below the diagonal of the blocks of each column that are not zero.
  explicit BlockCholesky(std::vector<std::set<uint32_t>> rows);

  // The rows below the diagonal of the blocks of L, which increase.
  const std::vector<uint32_t>& RowsOf(size_t column) const { return rows_[column]; }
  void SetZero() { std::ranges::fill(blocks_, Block::Zero()); }
  // A block of the matrix, and of L after Factorise(): one that is stored, not above the diagonal.
  Block& At(size_t row, size_t column) { return blocks_[IndexOf(row, column)]; }
  const Block& At(size_t row, size_t column) const { return blocks_[IndexOf(row, column)]; }

  // Replaces the matrix by L, with the diagonal of SquareRootForm. Returns false if it is not
  // positive semidefinite or not finite.
  bool Factorise(const Eigen::VectorXd& gradient);
  const Eigen::VectorXd& residual() const { return residual_; }  // L^-1 gradient

 private:
  size_t IndexOf(size_t row, size_t column) const;

  std::vector<std::vector<uint32_t>> rows_;
  std::vector<size_t> begins_;  // of the columns in blocks_; the block on the diagonal is the first
  std::vector<Block> blocks_;
  Eigen::VectorXd residual_;
};

}  // namespace hullslam::internal

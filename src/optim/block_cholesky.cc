// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/block_cholesky.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <iterator>

namespace hullslam::internal {

BlockCholesky::BlockCholesky(std::vector<std::set<uint32_t>> rows) {
  size_t count = 0;
  for (const std::set<uint32_t>& column : rows) {
    if (!column.empty()) {
      rows[*column.begin()].insert(std::next(column.begin()), column.end());
    }
    begins_.push_back(count);
    count += 1 + column.size();
    rows_.emplace_back(column.begin(), column.end());
  }
  blocks_.resize(count);
}

size_t BlockCholesky::IndexOf(size_t row, size_t column) const {
  const std::vector<uint32_t>& rows = rows_[column];
  const auto below = std::lower_bound(rows.begin(), rows.end(), row) - rows.begin();
  return begins_[column] + (row == column ? 0 : 1 + static_cast<size_t>(below));
}

bool BlockCholesky::Factorise(const Eigen::VectorXd& gradient) {
  double largest = 0.0;
  for (const size_t begin : begins_) {
    largest = std::max(largest, blocks_[begin].diagonal().maxCoeff());
  }
  for (const size_t begin : begins_) {
    blocks_[begin].diagonal() += 1e-9 * blocks_[begin].diagonal();
    blocks_[begin].diagonal().array() += 1e-12 * largest + 1e-30;
  }
  residual_ = gradient;
  for (size_t i = 0; i < rows_.size(); ++i) {
    Block* const column = &blocks_[begins_[i]];
    const Eigen::LLT<Block> factor(*column);
    if (factor.info() != Eigen::Success) {
      return false;
    }
    *column = factor.matrixL();
    Eigen::Ref<Eigen::Matrix<double, 6, 1>> solved =
        residual_.segment<6>(6 * static_cast<Eigen::Index>(i));
    factor.matrixL().solveInPlace(solved);
    for (size_t k = 0; k < rows_[i].size(); ++k) {
      Block& block = column[1 + k];
      factor.matrixU().solveInPlace<Eigen::OnTheRight>(block);
      residual_.segment<6>(6 * static_cast<Eigen::Index>(rows_[i][k])).noalias() -= block * solved;
      for (size_t l = 0; l <= k; ++l) {
        At(rows_[i][k], rows_[i][l]).noalias() -= block * column[1 + l].transpose();
      }
    }
  }
  return residual_.allFinite();
}

}  // namespace hullslam::internal

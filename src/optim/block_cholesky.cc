// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/block_cholesky.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace hullslam::internal {

BlockCholesky::BlockCholesky(std::vector<std::vector<uint32_t>> rows) : rows_(std::move(rows)) {
  size_t count = 0;
  for (std::vector<uint32_t>& column : rows_) {
    std::ranges::sort(column);
    column.erase(std::unique(column.begin(), column.end()), column.end());
    if (!column.empty()) {
      std::vector<uint32_t>& next = rows_[column.front()];
      next.insert(next.end(), column.begin() + 1, column.end());
    }
    column.shrink_to_fit();
    begins_.push_back(count);
    count += 1 + column.size();
  }
  blocks_.resize(count);
}

void BlockCholesky::SetZero() { std::ranges::fill(blocks_, Block::Zero()); }

const BlockCholesky::Block& BlockCholesky::At(size_t row, size_t column) const {
  const std::vector<uint32_t>& rows = rows_[column];
  const auto below = std::lower_bound(rows.begin(), rows.end(), row) - rows.begin();
  return blocks_[begins_[column] + (row == column ? 0 : 1 + static_cast<size_t>(below))];
}

BlockCholesky::Block& BlockCholesky::At(size_t row, size_t column) {
  return const_cast<Block&>(std::as_const(*this).At(row, column));
}

bool BlockCholesky::Factorise(const Eigen::VectorXd& gradient) {
  double largest = 0.0;
  for (size_t i = 0; i < size(); ++i) {
    largest = std::max(largest, At(i, i).diagonal().maxCoeff());
  }
  for (size_t i = 0; i < size(); ++i) {
    At(i, i).diagonal() += 1e-9 * At(i, i).diagonal();
    At(i, i).diagonal().array() += 1e-12 * largest + 1e-30;
  }
  residual_ = gradient;
  for (size_t i = 0; i < size(); ++i) {
    Block& diagonal = blocks_[begins_[i]];
    const Eigen::LLT<Block> factor(diagonal);
    if (factor.info() != Eigen::Success) {
      return false;
    }
    diagonal = factor.matrixL();
    Eigen::Matrix<double, 6, 1> solved = residual_.segment<6>(6 * static_cast<Eigen::Index>(i));
    factor.matrixL().solveInPlace(solved);
    residual_.segment<6>(6 * static_cast<Eigen::Index>(i)) = solved;
    const Block* const column = &diagonal + 1;
    for (size_t k = 0; k < rows_[i].size(); ++k) {
      Block& block = blocks_[begins_[i] + 1 + k];
      factor.matrixU().solveInPlace<Eigen::OnTheRight>(block);
      residual_.segment<6>(6 * static_cast<Eigen::Index>(rows_[i][k])).noalias() -= block * solved;
      for (size_t l = 0; l <= k; ++l) {
        At(rows_[i][k], rows_[i][l]).noalias() -= block * column[l].transpose();
      }
    }
  }
  return residual_.allFinite();
}

}  // namespace hullslam::internal

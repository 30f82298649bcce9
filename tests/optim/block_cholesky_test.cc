// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/block_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include "optim/square_root_form.h"

namespace hullslam::internal {
namespace {

constexpr uint32_t kColumns = 6;

// A band with two far blocks, as of a walk with a loop.
std::vector<std::set<uint32_t>> SomeRows() { return {{1, 5}, {2}, {3, 5}, {4}, {5}, {}}; }

// A positive definite matrix with nonzero blocks where `rows` has some, in both forms.
Eigen::MatrixXd Fill(BlockCholesky& sparse) {
  constexpr Eigen::Index kSize = 6 * kColumns;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kSize, kSize);
  sparse.SetZero();
  for (uint32_t column = 0; column < kColumns; ++column) {
    std::set<uint32_t> rows = SomeRows()[column];
    rows.insert(column);
    for (const uint32_t row : rows) {
      BlockCholesky::Block block;
      for (int i = 0; i < 36; ++i) {
        block(i % 6, i / 6) = std::sin(1.0 + i + 5.0 * row + 11.0 * column);
      }
      if (row == column) {
        block = (block * block.transpose() + 40.0 * BlockCholesky::Block::Identity()).eval();
      }
      sparse.At(row, column) = block;
      dense.block<6, 6>(6 * row, 6 * column) = block;
    }
  }
  return dense;
}

TEST(BlockCholesky, IsTheSquareRootFormOfTheWholeMatrix) {
  BlockCholesky sparse(SomeRows());
  SquareRootForm<Eigen::Dynamic> form;
  const Eigen::MatrixXd dense = Fill(sparse);
  const Eigen::VectorXd gradient = Eigen::VectorXd::LinSpaced(dense.rows(), -1.0, 2.0);
  ASSERT_TRUE(form.Compute(dense, gradient));
  ASSERT_TRUE(sparse.Factorise(gradient));
  EXPECT_LT((sparse.residual() - form.residual()).norm(), 1e-12);
  for (uint32_t column = 0; column < kColumns; ++column) {
    std::vector<uint32_t> rows = sparse.RowsOf(column);
    rows.push_back(column);
    for (const uint32_t row : rows) {
      EXPECT_LT(
          (sparse.At(row, column).transpose() - form.JacobianBlock<6>(6 * column, 6 * row)).norm(),
          1e-12);
    }
  }
}

TEST(BlockCholesky, StoresTheBlocksOfTheFactorOnly) {
  const BlockCholesky sparse(SomeRows());
  // The loop from 0 to 5 fills in row 5 of the columns 1 to 4.
  EXPECT_EQ(sparse.RowsOf(0), (std::vector<uint32_t>{1, 5}));
  EXPECT_EQ(sparse.RowsOf(1), (std::vector<uint32_t>{2, 5}));
  EXPECT_EQ(sparse.RowsOf(3), (std::vector<uint32_t>{4, 5}));
  EXPECT_TRUE(sparse.RowsOf(5).empty());
}

TEST(BlockCholesky, AMatrixThatIsNoHessianIsRefused) {
  BlockCholesky blocks(std::vector<std::set<uint32_t>>{{1}, {}});
  blocks.SetZero();
  EXPECT_TRUE(blocks.Factorise(Eigen::VectorXd::Zero(12)));
  blocks.SetZero();
  blocks.At(1, 1).diagonal().setConstant(-1.0);
  EXPECT_FALSE(blocks.Factorise(Eigen::VectorXd::Zero(12)));
  blocks.SetZero();
  blocks.At(1, 0).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(blocks.Factorise(Eigen::VectorXd::Zero(12)));
}

}  // namespace
}  // namespace hullslam::internal

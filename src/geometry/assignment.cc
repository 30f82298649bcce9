// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/assignment.h"

#include <cmath>
#include <limits>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

constexpr Eigen::Index kNone = -1;

// Adds one column per row; a row that is assigned to its own extra column is left out. Pairs that
// must not be chosen cost more than leaving the row out.
Eigen::MatrixXd Extended(const Eigen::MatrixXd& cost, double max_cost) {
  const Eigen::Index rows = cost.rows();
  const double never = max_cost + std::abs(max_cost) + 1.0;
  Eigen::MatrixXd extended = Eigen::MatrixXd::Constant(rows, cost.cols() + rows, never);
  extended.leftCols(cost.cols()) =
      cost.unaryExpr([&](double value) { return value < max_cost ? value : never; });
  extended.rightCols(rows).diagonal().setConstant(max_cost);
  return extended;
}

// Assigns one row after the other, each along the shortest path in reduced costs to a free column
// (Dijkstra). The prices keep all reduced costs non-negative.
class AugmentingPaths {
 public:
  explicit AugmentingPaths(const Eigen::MatrixXd& cost)
      : cost_(cost),
        row_price_(Eigen::VectorXd::Zero(cost.rows())),
        column_price_(Eigen::VectorXd::Zero(cost.cols())),
        row_of_(static_cast<size_t>(cost.cols()), kNone) {}

  void Add(Eigen::Index row) {
    const auto columns = static_cast<size_t>(cost_.cols());
    distance_.assign(columns, std::numeric_limits<double>::infinity());
    came_from_.assign(columns, kNone);
    is_done_.assign(columns, false);
    Eigen::Index column = kNone;  // the column reached last; kNone at the start, which is `row`
    double reached = 0.0;
    do {
      Relax(column == kNone ? row : RowOf(column), column, reached);
      column = Nearest();
      reached = distance_[static_cast<size_t>(column)];
      is_done_[static_cast<size_t>(column)] = true;
    } while (RowOf(column) != kNone);
    UpdatePrices(row, reached);
    Flip(column, row);
  }

  Eigen::Index RowOf(Eigen::Index column) const { return row_of_[static_cast<size_t>(column)]; }

 private:
  void Relax(Eigen::Index row, Eigen::Index from, double reached) {
    for (Eigen::Index column = 0; column < cost_.cols(); ++column) {
      const auto c = static_cast<size_t>(column);
      const double reduced = cost_(row, column) - row_price_[row] - column_price_[column];
      if (!is_done_[c] && reached + reduced < distance_[c]) {
        distance_[c] = reached + reduced;
        came_from_[c] = from;
      }
    }
  }

  Eigen::Index Nearest() const {
    size_t nearest = distance_.size();
    for (size_t c = 0; c < distance_.size(); ++c) {
      if (!is_done_[c] && (nearest == distance_.size() || distance_[c] < distance_[nearest])) {
        nearest = c;
      }
    }
    return static_cast<Eigen::Index>(nearest);
  }

  void UpdatePrices(Eigen::Index row, double length) {
    row_price_[row] += length;
    for (size_t c = 0; c < distance_.size(); ++c) {
      if (is_done_[c] && row_of_[c] != kNone) {
        row_price_[row_of_[c]] += length - distance_[c];
        column_price_[static_cast<Eigen::Index>(c)] -= length - distance_[c];
      }
    }
  }

  // Moves every row of the path to the next column of the path, so that `row` gets a column too.
  void Flip(Eigen::Index column, Eigen::Index row) {
    while (column != kNone) {
      const Eigen::Index before = came_from_[static_cast<size_t>(column)];
      row_of_[static_cast<size_t>(column)] = before == kNone ? row : RowOf(before);
      column = before;
    }
  }

  const Eigen::MatrixXd& cost_;
  Eigen::VectorXd row_price_;
  Eigen::VectorXd column_price_;
  std::vector<Eigen::Index> row_of_;  // by column
  std::vector<double> distance_;      // by column, along the shortest path to it
  std::vector<Eigen::Index> came_from_;
  std::vector<bool> is_done_;
};

}  // namespace

std::vector<int> AssignMinimumCost(const Eigen::MatrixXd& cost, double max_cost) {
  Check(std::isfinite(max_cost), "the cost of leaving a row out is not finite");
  std::vector<int> column_of(static_cast<size_t>(cost.rows()), -1);
  const Eigen::MatrixXd extended = Extended(cost, max_cost);
  AugmentingPaths paths(extended);
  for (Eigen::Index row = 0; row < cost.rows(); ++row) {
    paths.Add(row);
  }
  for (Eigen::Index column = 0; column < cost.cols(); ++column) {
    if (paths.RowOf(column) != kNone) {
      column_of[static_cast<size_t>(paths.RowOf(column))] = static_cast<int>(column);
    }
  }
  return column_of;
}

}  // namespace hullslam

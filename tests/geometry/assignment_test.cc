// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "hullslam/util/check.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

// Cost of an assignment, including the rows left out.
double TotalCost(const Eigen::MatrixXd& cost, const std::vector<int>& columns, double max_cost) {
  double total = 0.0;
  for (Eigen::Index row = 0; row < cost.rows(); ++row) {
    const int column = columns[static_cast<size_t>(row)];
    total += column < 0 ? max_cost : cost(row, column);
  }
  return total;
}

// The least cost of assigning the rows from `row` on, found by trying all assignments.
double LeastCost(const Eigen::MatrixXd& cost, double max_cost, Eigen::Index row,
                 std::vector<bool>& is_taken) {
  if (row == cost.rows()) {
    return 0.0;
  }
  double least = max_cost + LeastCost(cost, max_cost, row + 1, is_taken);
  for (Eigen::Index column = 0; column < cost.cols(); ++column) {
    const auto c = static_cast<size_t>(column);
    if (!is_taken[c] && cost(row, column) < max_cost) {
      is_taken[c] = true;
      least = std::min(least, cost(row, column) + LeastCost(cost, max_cost, row + 1, is_taken));
      is_taken[c] = false;
    }
  }
  return least;
}

Eigen::MatrixXd RandomCosts(RandomGeometry& random, Eigen::Index rows, Eigen::Index columns,
                            bool with_ties) {
  Eigen::MatrixXd cost(rows, columns);
  for (Eigen::Index i = 0; i < cost.size(); ++i) {
    const double value = random.Number(-2.0, 10.0);
    cost(i) = with_ties ? std::round(value) : value;
  }
  return cost;
}

void ExpectOneToOneBelow(const Eigen::MatrixXd& cost, const std::vector<int>& columns,
                         double max_cost) {
  std::set<int> taken;
  for (Eigen::Index row = 0; row < cost.rows(); ++row) {
    const int column = columns[static_cast<size_t>(row)];
    ASSERT_LT(column, cost.cols());
    if (column >= 0) {
      EXPECT_TRUE(taken.insert(column).second);
      EXPECT_LT(cost(row, column), max_cost);
    }
  }
}

TEST(AssignMinimumCost, MinimisesTheTotalCostAndNotTheCostOfEachRow) {
  Eigen::MatrixXd cost(2, 2);
  cost << 1.0, 2.0, 1.5, 9.0;  // column 0 is best for row 0, but row 1 needs it more
  EXPECT_EQ(AssignMinimumCost(cost, 10.0), (std::vector<int>{1, 0}));
}

TEST(AssignMinimumCost, HasTheLeastCostOfAllAssignments) {
  RandomGeometry random(1);
  for (int round = 0; round < 300; ++round) {
    const auto rows = static_cast<Eigen::Index>(1 + random.Index(6));
    const auto columns = static_cast<Eigen::Index>(1 + random.Index(6));
    const Eigen::MatrixXd cost = RandomCosts(random, rows, columns, round % 2 == 0);
    const double max_cost = random.Number(0.0, 12.0);
    const std::vector<int> assigned = AssignMinimumCost(cost, max_cost);
    ASSERT_EQ(assigned.size(), static_cast<size_t>(rows));
    ExpectOneToOneBelow(cost, assigned, max_cost);
    std::vector<bool> is_taken(static_cast<size_t>(columns), false);
    EXPECT_NEAR(TotalCost(cost, assigned, max_cost), LeastCost(cost, max_cost, 0, is_taken), 1e-9);
  }
}

TEST(AssignMinimumCost, TheTransposedProblemCostsTheSame) {
  RandomGeometry random(2);
  for (int round = 0; round < 20; ++round) {
    const Eigen::MatrixXd cost = RandomCosts(random, 30, 30, false);
    const double max_cost = 20.0;  // so large that no row is left out
    const Eigen::MatrixXd transposed = cost.transpose();
    EXPECT_NEAR(TotalCost(cost, AssignMinimumCost(cost, max_cost), max_cost),
                TotalCost(transposed, AssignMinimumCost(transposed, max_cost), max_cost), 1e-9);
  }
}

TEST(AssignMinimumCost, NeverChoosesAPairThatIsNotBelowTheLimit) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Eigen::MatrixXd cost(4, 4);
  cost << 5.0, infinity, infinity, infinity,  // exactly the limit
      infinity, 4.0, infinity, infinity,      //
      nan, nan, nan, nan,                     //
      infinity, 3.0, 1e300, infinity;
  EXPECT_EQ(AssignMinimumCost(cost, 5.0), (std::vector<int>{-1, -1, -1, 1}));
}

TEST(AssignMinimumCost, HandlesNoRowsOrNoColumns) {
  EXPECT_TRUE(AssignMinimumCost(Eigen::MatrixXd(0, 3), 1.0).empty());
  EXPECT_EQ(AssignMinimumCost(Eigen::MatrixXd(2, 0), 1.0), (std::vector<int>{-1, -1}));
}

TEST(AssignMinimumCost, IsDeterministicAmongEqualSolutions) {
  const Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(3, 3, 1.0);
  const std::vector<int> first = AssignMinimumCost(cost, 2.0);
  ExpectOneToOneBelow(cost, first, 2.0);
  EXPECT_EQ(TotalCost(cost, first, 2.0), 3.0);
  EXPECT_EQ(AssignMinimumCost(cost, 2.0), first);
}

TEST(AssignMinimumCost, RefusesALimitThatIsNotFinite) {
  EXPECT_THROW(
      AssignMinimumCost(Eigen::MatrixXd::Zero(1, 1), std::numeric_limits<double>::infinity()),
      CheckError);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/reduced_points_cost.h"

#include <ceres/crs_matrix.h>
#include <ceres/problem.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "optim/made_points.h"

namespace hullslam::internal {
namespace {

class ReducedPointsCostTest : public ::testing::Test {
 protected:
  static constexpr size_t kMoving = 3;
  static constexpr Eigen::Index kSize = 6 * kMoving;

  ReducedPointsCostTest() {
    for (const Rigid3& pose : made_.poses) {
      poses_.push_back(ToBlock(pose));
    }
  }
  // Residuals and, if asked for, the Jacobian by the six parameters of each moving pose.
  bool Evaluate(Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.evaluation_callback = &cost_;
    ceres::Problem problem(options);
    cost_.AddResiduals(problem);
    ceres::Problem::EvaluateOptions order;
    for (size_t i = 0; i < kMoving; ++i) {
      problem.SetManifold(poses_[i].data(), &manifold_);
      order.parameter_blocks.push_back(poses_[i].data());
    }
    std::vector<double> values;
    ceres::CRSMatrix by_pose;
    if (!problem.Evaluate(order, nullptr, &values, nullptr,
                          jacobian == nullptr ? nullptr : &by_pose)) {
      return false;
    }
    residuals = Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<int>(values.size()));
    if (jacobian != nullptr) {
      jacobian->setZero(by_pose.num_rows, by_pose.num_cols);
      for (int row = 0; row < by_pose.num_rows; ++row) {
        for (int i = by_pose.rows[row]; i < by_pose.rows[row + 1]; ++i) {
          (*jacobian)(row, by_pose.cols[i]) = by_pose.values[i];
        }
      }
    }
    return true;
  }

  MadePoints made_{5};
  std::vector<PoseBlock> poses_;
  PoseManifold manifold_;
  EliminatedPoints points_{made_.camera, made_.points, kMoving, PointLoss::kHuber};
  ReducedPointsCost cost_{points_, poses_};
};

TEST_F(ReducedPointsCostTest, HalfTheSquaredResidualIsTheCost) {
  const double expected = points_.Follow(made_.poses);
  Eigen::VectorXd residuals;
  ASSERT_TRUE(Evaluate(residuals, nullptr));
  EXPECT_NEAR(0.5 * residuals.squaredNorm(), expected, 1e-9 * expected);
  Eigen::MatrixXd jacobian;
  ASSERT_TRUE(Evaluate(residuals, &jacobian));
  EXPECT_EQ(residuals.size(), kSize + 1);
  EXPECT_NEAR(0.5 * residuals.squaredNorm(), expected, 1e-9 * expected);
}

TEST_F(ReducedPointsCostTest, GivesTheNormalEquationsOfThePoses) {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
  ASSERT_TRUE(Evaluate(residuals, &jacobian));
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  points_.Linearize(hessian, gradient);
  const Eigen::MatrixXd product = jacobian.transpose() * jacobian;
  const Eigen::MatrixXd difference = (product - hessian).triangularView<Eigen::Lower>();
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-8 * hessian.cwiseAbs().maxCoeff());
  EXPECT_LT((jacobian.transpose() * residuals - gradient).norm(), 1e-8 * gradient.norm());
}

// Ceres asks for derivatives when it keeps the poses that it tried.
TEST_F(ReducedPointsCostTest, PointsAreAcceptedWithTheDerivativesOnly) {
  const std::vector<Eigen::Vector3d> before = made_.points.positions();
  cost_.PrepareForEvaluation(false, true);
  EXPECT_EQ(made_.points.positions(), before);
  cost_.PrepareForEvaluation(true, false);
  const std::vector<Eigen::Vector3d> accepted = made_.points.positions();
  EXPECT_NE(accepted, before);
  cost_.PrepareForEvaluation(true, false);
  EXPECT_EQ(made_.points.positions(), accepted);
}

TEST_F(ReducedPointsCostTest, IsNotDefinedForAPointBehindACamera) {
  poses_[1] = ToBlock({Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0), Eigen::Vector3d::Zero()});
  Eigen::VectorXd residuals;
  EXPECT_FALSE(Evaluate(residuals, nullptr));
}

TEST_F(ReducedPointsCostTest, APoseWithoutInliersHasNoDerivative) {
  for (size_t i = 0; i < made_.points.size(); ++i) {
    for (BundlePoints::PointObservation& observation : made_.points.ObservationsOf(i)) {
      observation.is_inlier = observation.pose != 1;
    }
  }
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
  ASSERT_TRUE(Evaluate(residuals, &jacobian));
  EXPECT_LT((jacobian.transpose() * residuals).segment<6>(6).norm(), 1e-9);
}

}  // namespace
}  // namespace hullslam::internal

// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/reduced_points_cost.h"

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
  // Residuals and, if asked for, the Jacobian with 7 columns a pose.
  bool Evaluate(Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
    std::vector<const double*> parameters;
    std::vector<Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>> by_pose(kMoving);
    std::vector<double*> jacobians;
    for (size_t i = 0; i < kMoving; ++i) {
      parameters.push_back(poses_[i].data());
      by_pose[i].resize(kSize + 1, 7);
      jacobians.push_back(by_pose[i].data());
    }
    residuals.resize(kSize + 1);
    const bool is_defined = cost_.Evaluate(parameters.data(), residuals.data(),
                                           jacobian == nullptr ? nullptr : jacobians.data());
    if (jacobian != nullptr) {
      jacobian->resize(kSize + 1, kSize);
      for (size_t i = 0; i < kMoving; ++i) {
        jacobian->middleCols(6 * static_cast<Eigen::Index>(i), 6) = by_pose[i].leftCols<6>();
        EXPECT_TRUE(by_pose[i].col(6).isZero(0.0));
      }
    }
    return is_defined;
  }

  MadePoints made_{5};
  std::vector<PoseBlock> poses_;
  EliminatedPoints points_{made_.camera, made_.points, kMoving, true};
  ReducedPointsCost cost_{points_, poses_};
};

TEST_F(ReducedPointsCostTest, HalfTheSquaredResidualIsTheCost) {
  cost_.PrepareForEvaluation(false, true);
  const double expected = points_.Follow(made_.poses);
  Eigen::VectorXd residuals;
  ASSERT_TRUE(Evaluate(residuals, nullptr));
  EXPECT_NEAR(0.5 * residuals.squaredNorm(), expected, 1e-9 * expected);
  cost_.PrepareForEvaluation(true, true);
  Eigen::MatrixXd jacobian;
  ASSERT_TRUE(Evaluate(residuals, &jacobian));
  EXPECT_NEAR(0.5 * residuals.squaredNorm(), expected, 1e-9 * expected);
}

TEST_F(ReducedPointsCostTest, GivesTheNormalEquationsOfThePoses) {
  cost_.PrepareForEvaluation(true, true);
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
  cost_.PrepareForEvaluation(true, true);
  Eigen::VectorXd residuals;
  EXPECT_FALSE(Evaluate(residuals, nullptr));
}

TEST_F(ReducedPointsCostTest, APoseWithoutInliersHasNoDerivative) {
  for (size_t i = 0; i < made_.points.size(); ++i) {
    for (BundlePoints::View& view : made_.points.ViewsOf(i)) {
      view.is_inlier = view.pose != 1;
    }
  }
  cost_.PrepareForEvaluation(true, true);
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
  ASSERT_TRUE(Evaluate(residuals, &jacobian));
  EXPECT_LT((jacobian.transpose() * residuals).segment<6>(6).norm(), 1e-9);
}

}  // namespace
}  // namespace hullslam::internal

// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/pose_problem.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "support/random_geometry.h"

namespace hullslam::internal {
namespace {

// A problem whose minimum is the pose `goal`. Its cost is the sum over three points, such as (0, 0,
// 2), of the squared distance (in cm) between the moved point and the point moved by `goal`.
class PointsToPositions {
 public:
  explicit PointsToPositions(const Rigid3& goal) : goal_(goal) {}

  double Cost(const Rigid3& pose) const {
    double cost = 0.0;
    for (const Eigen::Vector3d& point : kPoints) {
      cost += Residual(pose, point).squaredNorm();
    }
    return cost;
  }
  void Linearize(const Rigid3& pose, Matrix6d& hessian, Vector6d& gradient) const {
    hessian.setZero();
    gradient.setZero();
    for (const Eigen::Vector3d& point : kPoints) {
      Eigen::Matrix<double, 3, 6> jacobian;
      jacobian << -Skew(pose * point), Eigen::Matrix3d::Identity();
      jacobian *= 100.0;
      hessian += jacobian.transpose() * jacobian;
      gradient += jacobian.transpose() * Residual(pose, point);
    }
  }

 private:
  Eigen::Vector3d Residual(const Rigid3& pose, const Eigen::Vector3d& point) const {
    return 100.0 * (pose * point - goal_ * point);
  }

  inline static const std::array<Eigen::Vector3d, 3> kPoints = {Eigen::Vector3d(0.0, 0.0, 2.0),
                                                                Eigen::Vector3d(1.0, 0.0, 1.0),
                                                                Eigen::Vector3d(0.0, 1.0, 3.0)};
  Rigid3 goal_;
};

class NowhereDefined {
 public:
  double Cost(const Rigid3&) const { return std::numeric_limits<double>::infinity(); }
  void Linearize(const Rigid3&, Matrix6d& hessian, Vector6d& gradient) const {
    hessian.setConstant(std::numeric_limits<double>::quiet_NaN());
    gradient.setZero();
  }
};

TEST(TinyPoseFunction, TheSquaredResidualsAreTheCost) {
  RandomGeometry random(1);
  const PointsToPositions problem(random.Pose(0.5, 0.3));
  const TinyPoseFunction function(problem, random.Pose(0.5, 0.3));
  const Vector6d steps = Vector6d::Constant(0.1);
  Eigen::Matrix<double, 7, 1> residuals;
  Eigen::Matrix<double, 7, 6> jacobian;
  const double cost = problem.Cost(function.PoseAt(steps));
  function(steps.data(), residuals.data(), nullptr);
  EXPECT_NEAR(residuals.squaredNorm(), cost, 1e-9 * cost);
  function(steps.data(), residuals.data(), jacobian.data());
  EXPECT_NEAR(residuals.squaredNorm(), cost, 1e-9 * cost);
}

// Twice J^T r is the derivative of the cost by the parameters, also after several linearisations.
TEST(TinyPoseFunction, TheDerivativeIsThatOfTheCost) {
  RandomGeometry random(2);
  const PointsToPositions problem(random.Pose(0.5, 0.3));
  const TinyPoseFunction function(problem, random.Pose(0.5, 0.3));
  Vector6d steps = Vector6d::Zero();
  for (int round = 0; round < 3; ++round) {
    Eigen::Matrix<double, 7, 1> residuals;
    Eigen::Matrix<double, 7, 6> jacobian;
    function(steps.data(), residuals.data(), jacobian.data());
    const Vector6d gradient = 2.0 * jacobian.transpose() * residuals;
    for (int i = 0; i < 6; ++i) {
      const Vector6d step = 1e-5 * Vector6d::Unit(i);
      const double difference =
          problem.Cost(function.PoseAt(steps + step)) - problem.Cost(function.PoseAt(steps - step));
      EXPECT_NEAR(difference / 2e-5, gradient[i], 1e-4 * gradient.norm()) << round << ' ' << i;
    }
    steps += 0.3 * Vector6d(random.Vector(1.0).replicate<2, 1>());
  }
}

TEST(Minimize, FindsThePose) {
  RandomGeometry random(3);
  for (int i = 0; i < 20; ++i) {
    const Rigid3 goal = random.Pose(0.4, 0.5);
    const Rigid3 found = Minimize(PointsToPositions(goal), random.Pose(0.4, 0.5),
                                  {.iterations = 30, .min_relative_decrease = 1e-15});
    EXPECT_LT((found.ToMatrix() - goal.ToMatrix()).norm(), 1e-6);
  }
}

TEST(Minimize, StaysWhereTheProblemIsNotDefined) {
  const Rigid3 start = RandomGeometry(4).Pose(0.4, 0.5);
  EXPECT_LT((Minimize(NowhereDefined(), start, {}).ToMatrix() - start.ToMatrix()).norm(), 1e-15);
}

}  // namespace
}  // namespace hullslam::internal

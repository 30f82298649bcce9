// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/object_sum_cost.h"

#include <ceres/sized_cost_function.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

#include "objects/constraint/object_constraint.h"
#include "objects/made_objects.h"
#include "optim/bundle_adjustment.h"
#include "support/random_geometry.h"

namespace hullslam::internal {
namespace {

using Camera = ObjectSumCost::Camera;
using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A cost that is never defined.
class UndefinedCost final : public ceres::SizedCostFunction<1, 7, 7, 3> {
 public:
  bool Evaluate(double const* const*, double*, double**) const override { return false; }
};

struct Evaluation {
  bool is_defined = false;
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;  // by the tangents of the blocks
};

Evaluation Evaluate(const ceres::CostFunction& cost, const std::vector<const double*>& parameters) {
  Evaluation result;
  result.residuals.resize(cost.num_residuals());
  std::vector<Jacobian> blocks;
  std::vector<double*> pointers;
  for (const int size : cost.parameter_block_sizes()) {
    blocks.emplace_back(cost.num_residuals(), size);
  }
  for (Jacobian& block : blocks) {
    pointers.push_back(block.data());
  }
  result.is_defined = cost.Evaluate(parameters.data(), result.residuals.data(), pointers.data());
  result.jacobian.resize(cost.num_residuals(), 0);
  for (const Jacobian& block : blocks) {
    const Eigen::Index width = std::min<Eigen::Index>(block.cols(), 6);
    const Eigen::Index before = result.jacobian.cols();
    result.jacobian.conservativeResize(Eigen::NoChange, before + width);
    result.jacobian.rightCols(width) = block.leftCols(width);
  }
  return result;
}

class ObjectSumCostTest : public ::testing::Test {
 protected:
  ObjectSumCostTest() {
    object_ = MakeObject("cup", {0.1, -0.2, 2.0}, {0.3, 0.2, 0.1}, 0.4);
    object_block_ = ToBlock(object_.ellipsoid.world_from_object);
    // Not the true axes, so that no residual is zero.
    log_axes_ = (1.2 * object_.ellipsoid.half_axes).array().log();
    RandomGeometry random(3);
    for (int i = 0; i < 3; ++i) {
      cameras_.push_back(ToBlock(random.Pose(0.05, 0.1)));
    }
  }
  // The outline and the depth points of the object in the observation of a camera.
  ObjectConstraint ConstraintOf(size_t camera) const {
    const Rigid3 pose = FromBlock(cameras_[camera].data());
    const Detection detection = Detect(object_, sensor_, pose);
    return MakeObjectConstraint(sensor_.camera, {KeyframeId(0), pose, &detection}, detection.lines,
                                object_.ellipsoid, 0.0, BundleOptions().objects.constraint);
  }
  std::unique_ptr<ceres::CostFunction> Prior() const {
    return MakeObjectPrior(object_.ellipsoid, true, {});
  }
  std::vector<const double*> Parameters(size_t camera) const {
    return {cameras_[camera].data(), object_block_.data(), log_axes_.data()};
  }
  std::vector<const double*> ObjectParameters() const {
    return {object_block_.data(), log_axes_.data()};
  }

  MadeObject object_;
  Sensor sensor_ = MakeObjectSensor();
  PoseBlock object_block_{};
  Eigen::Vector3d log_axes_;
  std::vector<PoseBlock> cameras_;
};

void ExpectSameNormalEquations(const Evaluation& sum, const Eigen::MatrixXd& hessian,
                               const Eigen::VectorXd& gradient, double squared_norm) {
  ASSERT_TRUE(sum.is_defined);
  EXPECT_LT((sum.jacobian.transpose() * sum.jacobian - hessian).norm(), 1e-8 * hessian.norm());
  EXPECT_LT((sum.jacobian.transpose() * sum.residuals - gradient).norm(), 1e-8 * gradient.norm());
  EXPECT_NEAR(sum.residuals.squaredNorm(), squared_norm, 1e-9 * squared_norm);
}

TEST_F(ObjectSumCostTest, AViewOfAMovingCameraHasTheNormalEquationsOfItsCosts) {
  ObjectSumCost sum(Camera::kMoving);
  EXPECT_EQ(sum.size(), 0u);
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(15, 15);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(15);
  double squared_norm = 0.0;
  ObjectConstraint constraint = ConstraintOf(0);
  for (auto* const cost : {&constraint.silhouette, &constraint.depth}) {
    ASSERT_NE(*cost, nullptr);
    const Evaluation one = Evaluate(**cost, Parameters(0));
    hessian += one.jacobian.transpose() * one.jacobian;
    gradient += one.jacobian.transpose() * one.residuals;
    squared_norm += one.residuals.squaredNorm();
    sum.Add(std::move(*cost));
  }
  EXPECT_EQ(sum.size(), 2u);
  EXPECT_EQ(sum.num_residuals(), 16);
  ExpectSameNormalEquations(Evaluate(sum, Parameters(0)), hessian, gradient, squared_norm);
}

TEST_F(ObjectSumCostTest, FixedViewsAndThePriorAreTenRows) {
  ObjectSumCost sum(Camera::kNone);
  const Evaluation prior = Evaluate(*Prior(), ObjectParameters());
  Eigen::MatrixXd hessian = prior.jacobian.transpose() * prior.jacobian;
  Eigen::VectorXd gradient = prior.jacobian.transpose() * prior.residuals;
  double squared_norm = prior.residuals.squaredNorm();
  sum.Add(Prior());
  for (size_t i = 0; i < cameras_.size(); ++i) {
    ObjectConstraint constraint = ConstraintOf(i);
    const Evaluation one = Evaluate(*constraint.silhouette, Parameters(i));
    const Eigen::MatrixXd by_object = one.jacobian.rightCols<9>();
    hessian += by_object.transpose() * by_object;
    gradient += by_object.transpose() * one.residuals;
    squared_norm += one.residuals.squaredNorm();
    sum.Add(std::move(constraint.silhouette), cameras_[i]);
  }
  EXPECT_EQ(sum.num_residuals(), 10);
  ExpectSameNormalEquations(Evaluate(sum, ObjectParameters()), hessian, gradient, squared_norm);
}

TEST_F(ObjectSumCostTest, WithoutDerivativesTheNormIsTheSame) {
  ObjectSumCost sum(Camera::kMoving);
  sum.Add(ConstraintOf(1).silhouette);
  const double expected = Evaluate(sum, Parameters(1)).residuals.squaredNorm();
  Eigen::VectorXd residuals(sum.num_residuals());
  ASSERT_TRUE(sum.Evaluate(Parameters(1).data(), residuals.data(), nullptr));
  EXPECT_NEAR(residuals.squaredNorm(), expected, 1e-9 * expected);
}

TEST_F(ObjectSumCostTest, DerivativesThatAreNotAskedForAreNotWritten) {
  ObjectSumCost sum(Camera::kMoving);
  sum.Add(ConstraintOf(1).silhouette);
  const Evaluation all = Evaluate(sum, Parameters(1));
  Eigen::VectorXd residuals(sum.num_residuals());
  Jacobian by_axes(sum.num_residuals(), 3);
  double* blocks[] = {nullptr, nullptr, by_axes.data()};
  ASSERT_TRUE(sum.Evaluate(Parameters(1).data(), residuals.data(), blocks));
  EXPECT_EQ(Eigen::MatrixXd(by_axes), Eigen::MatrixXd(all.jacobian.rightCols<3>()));
}

TEST_F(ObjectSumCostTest, IsDefinedWhereAllCostsAre) {
  ObjectSumCost sum(Camera::kMoving);
  sum.Add(ConstraintOf(0).silhouette);
  EXPECT_TRUE(Evaluate(sum, Parameters(0)).is_defined);
  sum.Add(std::make_unique<UndefinedCost>());
  EXPECT_FALSE(Evaluate(sum, Parameters(0)).is_defined);
  Eigen::VectorXd residuals(sum.num_residuals());
  EXPECT_FALSE(sum.Evaluate(Parameters(0).data(), residuals.data(), nullptr));
}

TEST_F(ObjectSumCostTest, AnUndefinedCostCanBeLeftOut) {
  ObjectSumCost sum(Camera::kMoving);
  sum.Add(ConstraintOf(0).silhouette);
  const Evaluation expected = Evaluate(sum, Parameters(0));
  EXPECT_FALSE(sum.HasUndefined());
  sum.Add(std::make_unique<UndefinedCost>());
  EXPECT_TRUE(sum.AreLeftOutDefined(Parameters(0).data()));
  Evaluate(sum, Parameters(0));
  ASSERT_TRUE(sum.HasUndefined());
  sum.LeaveOutUndefined();
  EXPECT_FALSE(sum.HasUndefined());
  EXPECT_EQ(sum.size(), 1u);
  EXPECT_FALSE(sum.AreLeftOutDefined(Parameters(0).data()));
  const Evaluation left = Evaluate(sum, Parameters(0));
  ASSERT_TRUE(left.is_defined);
  EXPECT_EQ(left.residuals, expected.residuals);
  EXPECT_EQ(left.jacobian, expected.jacobian);
}

// At other parameters the cost may be defined again.
TEST_F(ObjectSumCostTest, ACostIsUndefinedOnlyWhereItWasEvaluatedLast) {
  ObjectSumCost sum(Camera::kMoving);
  sum.Add(ConstraintOf(0).silhouette);
  std::vector<const double*> behind = Parameters(0);
  const PoseBlock turned =
      ToBlock({Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0), Eigen::Vector3d::Zero()});
  behind[0] = turned.data();
  EXPECT_FALSE(Evaluate(sum, behind).is_defined);
  EXPECT_TRUE(sum.HasUndefined());
  EXPECT_TRUE(Evaluate(sum, Parameters(0)).is_defined);
  EXPECT_FALSE(sum.HasUndefined());
}

}  // namespace
}  // namespace hullslam::internal

// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/defined_cost.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>

namespace hullslam {
namespace {

// The residual x - 3, which is not defined between 1 and 2.
class GapCost final : public ceres::SizedCostFunction<1, 1> {
 public:
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const double x = parameters[0][0];
    if (x > 1.0 && x < 2.0) {
      return false;
    }
    residuals[0] = x - 3.0;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      jacobians[0][0] = 1.0;
    }
    return true;
  }
};

struct Evaluation {
  bool ok = false;
  double residual = 0.0;
  double jacobian = 0.0;
};

Evaluation Evaluate(const ceres::CostFunction& cost, double x) {
  Evaluation evaluation;
  const std::array<const double*, 1> parameters = {&x};
  std::array<double*, 1> jacobians = {&evaluation.jacobian};
  evaluation.ok = cost.Evaluate(parameters.data(), &evaluation.residual, jacobians.data());
  return evaluation;
}

TEST(DefinedCost, EqualsTheWrappedCostWhereThatIsDefined) {
  const DefinedCost cost(std::make_unique<GapCost>());
  const Evaluation evaluation = Evaluate(cost, 0.5);
  EXPECT_TRUE(evaluation.ok);
  EXPECT_EQ(evaluation.residual, -2.5);
  EXPECT_EQ(evaluation.jacobian, 1.0);
}

TEST(DefinedCost, IsFarAndDoesNotChangeElsewhere) {
  const DefinedCost cost(std::make_unique<GapCost>());
  EXPECT_FALSE(Evaluate(GapCost(), 1.5).ok);
  const Evaluation evaluation = Evaluate(cost, 1.5);
  EXPECT_TRUE(evaluation.ok);
  EXPECT_EQ(evaluation.residual, DefinedCost::kFar);
  EXPECT_EQ(evaluation.jacobian, 0.0);
  double residual = 0.0;
  const double x = 1.5;
  const double* parameters = &x;
  EXPECT_TRUE(cost.Evaluate(&parameters, &residual, nullptr));
  EXPECT_EQ(residual, DefinedCost::kFar);
}

struct Pull {
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    residual[0] = 10.0 * (x[0] - 1.5);
    return true;
  }
};

// Many costs x - 1.5 under Cauchy's loss. At their minimum one other cost is not defined.
double Solve(bool is_defined) {
  double x = 0.0;
  ceres::Problem problem;
  for (int i = 0; i < 100; ++i) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Pull, 1, 1>(new Pull),
                             new ceres::CauchyLoss(4.0), &x);
  }
  ceres::CostFunction* const gap = new GapCost;
  problem.AddResidualBlock(
      is_defined ? new DefinedCost(std::unique_ptr<ceres::CostFunction>(gap)) : gap,
      new ceres::CauchyLoss(4.0), &x);
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return x;
}

TEST(DefinedCost, AnUndefinedCostDoesNotHoldTheOthers) {
  EXPECT_LT(Solve(false), 1.0);
  EXPECT_NEAR(Solve(true), 1.5, 1e-6);
}

}  // namespace
}  // namespace hullslam

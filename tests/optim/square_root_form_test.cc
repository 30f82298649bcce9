// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/square_root_form.h"

#include <gtest/gtest.h>

#include <limits>

namespace hullslam::internal {
namespace {

using Form = SquareRootForm<3>;

Form::Matrix SomeHessian() {
  Form::Matrix root;
  root << 2.0, 0.3, -1.0, 0.0, 1.5, 0.4, 0.7, 0.0, 3.0;
  return root.transpose() * root;
}

TEST(SquareRootForm, GivesTheNormalEquationsBack) {
  const Form::Vector gradient(1.0, -2.0, 0.5);
  Form form;
  ASSERT_TRUE(form.Compute(SomeHessian().triangularView<Eigen::Lower>(), gradient));
  const Form::Matrix jacobian = form.jacobian();
  EXPECT_LT((jacobian.transpose() * jacobian - SomeHessian()).norm(), 1e-7);
  EXPECT_LT((jacobian.transpose() * form.residual() - gradient).norm(), 1e-12);
}

TEST(SquareRootForm, ABlockOfTheJacobianIsAPartOfIt) {
  SquareRootForm<Eigen::Dynamic> form;
  const Eigen::MatrixXd root = Eigen::MatrixXd::Identity(6, 6) + Eigen::MatrixXd::Ones(6, 6);
  ASSERT_TRUE(form.Compute(root, Eigen::VectorXd::Ones(6)));
  const Eigen::MatrixXd jacobian = form.jacobian();
  EXPECT_EQ(form.JacobianBlock<2>(2, 2), (jacobian.block<2, 2>(2, 2)));
  EXPECT_EQ(form.JacobianBlock<2>(0, 4), (jacobian.block<2, 2>(0, 4)));
}

TEST(SquareRootForm, TheLastResidualCompletesTheNorm) {
  Form form;
  ASSERT_TRUE(form.Compute(SomeHessian(), {1.0, -2.0, 0.5}));
  const double last = form.LastResidual(7.0);
  EXPECT_NEAR(form.residual().squaredNorm() + last * last, 7.0, 1e-12);
  EXPECT_EQ(form.LastResidual(0.0), 0.0);
}

TEST(SquareRootForm, AParameterWithoutInfluenceDoesNotMove) {
  Form::Matrix hessian = SomeHessian();
  hessian.row(1).setZero();
  hessian.col(1).setZero();
  Form form;
  ASSERT_TRUE(form.Compute(hessian, {1.0, 0.0, 0.5}));
  const Form::Matrix jacobian = form.jacobian();
  EXPECT_EQ((jacobian.transpose() * form.residual())[1], 0.0);
  EXPECT_TRUE(form.Compute(Form::Matrix::Zero(), Form::Vector::Zero()));
}

TEST(SquareRootForm, AMatrixThatIsNoHessianIsRefused) {
  Form form;
  EXPECT_FALSE(form.Compute(-SomeHessian(), Form::Vector::Zero()));
  EXPECT_FALSE(form.Compute(Form::Matrix::Constant(std::numeric_limits<double>::quiet_NaN()),
                            Form::Vector::Zero()));
}

}  // namespace
}  // namespace hullslam::internal

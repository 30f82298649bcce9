// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/eliminated_points.h"

#include <ceres/crs_matrix.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "costs/manifolds.h"
#include "optim/made_points.h"
#include "optim/reprojection.h"
#include "util/statistics.h"

namespace hullslam::internal {
namespace {

// The same points with the costs and the loss that Ceres sees without elimination.
class CeresPoints {
 public:
  CeresPoints(MadePoints& made, PointLoss point_loss) : positions_(made.points.positions()) {
    for (const Rigid3& pose : made.poses) {
      poses_.push_back(ToBlock(pose));
    }
    for (PoseBlock& pose : poses_) {
      problem_.AddParameterBlock(pose.data(), 7, new PoseManifold);
      blocks_.push_back(pose.data());
    }
    for (size_t i = 0; i < positions_.size(); ++i) {
      problem_.AddParameterBlock(positions_[i].data(), 3);
      blocks_.push_back(positions_[i].data());
      for (const BundlePoints::PointObservation& observation : made.points.ObservationsOf(i)) {
        AddView(made.camera, observation, i, point_loss);
      }
    }
  }

  double Cost() {
    double cost = 0.0;
    problem_.Evaluate({}, &cost, nullptr, nullptr, nullptr);
    return cost;
  }
  // J^T J and J^T r. The 6 parameters of each pose come first, then the 3 of each point.
  void Normal(Eigen::MatrixXd& hessian, Eigen::VectorXd& gradient) {
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = blocks_;
    std::vector<double> by_parameter;
    ceres::CRSMatrix rows;
    problem_.Evaluate(options, nullptr, nullptr, &by_parameter, &rows);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows.num_rows, rows.num_cols);
    for (int row = 0; row < rows.num_rows; ++row) {
      for (int k = rows.rows[row]; k < rows.rows[row + 1]; ++k) {
        jacobian(row, rows.cols[k]) = rows.values[k];
      }
    }
    hessian = jacobian.transpose() * jacobian;
    gradient = Eigen::Map<Eigen::VectorXd>(by_parameter.data(), rows.num_cols);
  }

 private:
  void AddView(const PinholeCamera& camera, const BundlePoints::PointObservation& observation,
               size_t point, PointLoss point_loss) {
    if (!observation.is_inlier) {
      return;
    }
    const bool has_depth = observation.measurement.has_depth();
    ceres::CostFunction* cost = nullptr;
    if (has_depth) {
      cost = new RgbdReprojectionCost(camera, observation.measurement);
    } else {
      cost = new ReprojectionCost(camera, observation.measurement);
    }
    ceres::LossFunction* loss = nullptr;
    if (point_loss == PointLoss::kHuber) {
      loss = new ceres::HuberLoss(std::sqrt(Chi2Bound(has_depth ? 3 : 2)));
    } else if (point_loss == PointLoss::kCauchy) {
      loss = new ceres::CauchyLoss(kCauchyScale);
    }
    loss = new ceres::ScaledLoss(loss, observation.weight, ceres::TAKE_OWNERSHIP);
    problem_.AddResidualBlock(cost, loss, poses_[observation.pose].data(),
                              positions_[point].data());
  }

  std::vector<PoseBlock> poses_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<double*> blocks_;
  ceres::Problem problem_;
};

// Calls Follow() until the points do not move any more.
double Settle(EliminatedPoints& eliminated, const std::vector<Rigid3>& poses) {
  double cost = 0.0;
  for (int i = 0; i < 300; ++i) {
    cost = eliminated.Follow(poses);
    eliminated.Accept();
  }
  return cost;
}

class EliminatedPointsTest : public ::testing::TestWithParam<PointLoss> {
 protected:
  PointLoss loss() const { return GetParam(); }
};

std::string NameOf(const ::testing::TestParamInfo<PointLoss>& test) {
  constexpr std::array kNames{"Squared", "Huber", "Cauchy"};
  return kNames.at(static_cast<size_t>(test.param));
}

INSTANTIATE_TEST_SUITE_P(Losses, EliminatedPointsTest,
                         ::testing::Values(PointLoss::kNone, PointLoss::kHuber, PointLoss::kCauchy),
                         NameOf);

TEST_P(EliminatedPointsTest, TheCostIsThatOfCeresAtTheMovedPoints) {
  MadePoints made(5);
  const double before = CeresPoints(made, loss()).Cost();
  EliminatedPoints eliminated(made.camera, made.points, 5, loss());
  const double cost = eliminated.Follow(made.poses);
  EXPECT_LT(cost, before);
  EXPECT_EQ(CeresPoints(made, loss()).Cost(), before);  // not accepted yet
  eliminated.Accept();
  EXPECT_NEAR(CeresPoints(made, loss()).Cost(), cost, 1e-9 * cost);
}

// The system is the Schur complement of the points in the normal equations of all parameters. With
// a single moving pose, a point is coupled with this pose only.
void ExpectSchurComplement(Eigen::Index moving, PointLoss loss, bool is_settled) {
  MadePoints made(5);
  EliminatedPoints eliminated(made.camera, made.points, static_cast<size_t>(moving), loss);
  Settle(eliminated, made.poses);
  if (!is_settled) {  // the points have gradients of their own
    for (Rigid3& pose : made.poses) {
      pose.translation.x() += 0.001;
    }
    eliminated.Follow(made.poses);
  }
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  eliminated.Linearize(hessian, gradient);

  Eigen::MatrixXd all;
  Eigen::VectorXd all_gradient;
  CeresPoints(made, loss).Normal(all, all_gradient);
  const Eigen::Index first = 6 * 5;
  const Eigen::Index points = all.rows() - first;
  const Eigen::MatrixXd coupling = all.block(0, first, 6 * moving, points);
  const Eigen::MatrixXd inverse = all.bottomRightCorner(points, points).inverse();
  const Eigen::MatrixXd expected =
      all.topLeftCorner(6 * moving, 6 * moving) - coupling * inverse * coupling.transpose();
  const Eigen::VectorXd expected_gradient =
      all_gradient.head(6 * moving) - coupling * inverse * all_gradient.tail(points);
  ASSERT_EQ(hessian.rows(), 6 * moving);
  // The damping of the points changes it a little.
  const Eigen::MatrixXd difference = (hessian - expected).triangularView<Eigen::Lower>();
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-5 * expected.cwiseAbs().maxCoeff());
  EXPECT_LT((gradient - expected_gradient).cwiseAbs().maxCoeff(),
            1e-5 * expected_gradient.cwiseAbs().maxCoeff());
}

TEST_P(EliminatedPointsTest, TheSystemIsTheSchurComplementOfThatOfCeres) {
  for (const Eigen::Index moving : {1, 3}) {
    for (const bool is_settled : {true, false}) {
      ExpectSchurComplement(moving, loss(), is_settled);
    }
  }
}

// The derivative of the cost at the best positions of the points.
TEST_P(EliminatedPointsTest, TheGradientIsTheDerivativeOfTheCost) {
  MadePoints made(4);
  EliminatedPoints eliminated(made.camera, made.points, 3, loss());
  Settle(eliminated, made.poses);
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  eliminated.Follow(made.poses);
  eliminated.Linearize(hessian, gradient);
  constexpr double kStep = 1e-5;
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    std::array<double, 2> costs = {};
    for (const int side : {0, 1}) {
      std::vector<Rigid3> poses = made.poses;
      Eigen::Matrix<double, 6, 1> delta = Eigen::Matrix<double, 6, 1>::Zero();
      delta[i % 6] = side == 0 ? -kStep : kStep;
      Rigid3& pose = poses[static_cast<size_t>(i / 6)];
      pose = Retract(pose, delta);
      costs.at(static_cast<size_t>(side)) = Settle(eliminated, poses);
    }
    EXPECT_NEAR((costs[1] - costs[0]) / (2.0 * kStep), gradient[i],
                1e-3 * gradient.cwiseAbs().maxCoeff())
        << i;
  }
}

TEST(EliminatedPoints, MoreStepsComeNearerToTheBestPositions) {
  MadePoints made(5);
  for (Eigen::Vector3d& position : made.points.positions()) {
    position *= 1.5;  // away from the first camera
  }
  std::vector<double> costs;
  for (const int steps : {1, 2, 10}) {
    costs.push_back(
        EliminatedPoints(made.camera, made.points, 5, PointLoss::kNone, {.steps = steps})
            .Follow(made.poses));
  }
  EXPECT_LT(costs[1], 0.9 * costs[0]);
  EXPECT_LT(costs[2], costs[1]);
  EliminatedPoints settled(made.camera, made.points, 5, PointLoss::kNone);
  EXPECT_LT(costs[2], 1.001 * Settle(settled, made.poses));
}

TEST(EliminatedPoints, ViewsThatAreNoInliersHaveNoInfluence) {
  MadePoints made(4);
  MadePoints other(4);
  for (size_t i = 0; i < other.points.size(); ++i) {
    made.points.ObservationsOf(i)[0].is_inlier = false;
    other.points.ObservationsOf(i)[0].is_inlier = false;
    other.points.ObservationsOf(i)[0].measurement.measured.setConstant(1e5);
  }
  EliminatedPoints first(made.camera, made.points, 4, PointLoss::kHuber);
  EliminatedPoints second(other.camera, other.points, 4, PointLoss::kHuber);
  EXPECT_EQ(first.Follow(made.poses), second.Follow(other.poses));
  first.Accept();
  second.Accept();
  Eigen::MatrixXd hessian;
  Eigen::MatrixXd other_hessian;
  Eigen::VectorXd gradient;
  Eigen::VectorXd other_gradient;
  first.Linearize(hessian, gradient);
  second.Linearize(other_hessian, other_gradient);
  EXPECT_EQ(hessian, other_hessian);
  EXPECT_EQ(gradient, other_gradient);
  EXPECT_EQ(made.points.positions(), other.points.positions());
}

TEST(EliminatedPoints, APointBehindACameraHasAnInfiniteCost) {
  MadePoints made(3);
  std::vector<Rigid3> turned = made.poses;
  turned[1].rotation = Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0);
  EliminatedPoints eliminated(made.camera, made.points, 3, PointLoss::kHuber);
  EXPECT_EQ(eliminated.Follow(turned), std::numeric_limits<double>::infinity());
  EXPECT_LT(eliminated.Follow(made.poses),
            1e9);  // the point starts again from its accepted position
}

// If the observations of a point agree exactly, no step can lower its cost. This must not be
// mistaken for a failed step: after a failed step a point is damped, and it holds the poses that
// see it.
TEST(EliminatedPoints, APointWhoseViewsAgreeExactlyFollowsThePoses) {
  MadePoints made(3);
  BundlePoints exact;
  for (const Eigen::Vector3d& position : made.points.positions()) {
    exact.AddPoint(position);
    for (size_t i = 0; i < made.poses.size(); ++i) {
      const Eigen::Vector3d image = ProjectRgbd(made.camera, made.poses[i] * position);
      exact.AddView({.measured = image, .inverse_sigma = {1.0, 1.0, 0.0}}, i);
    }
  }
  EliminatedPoints eliminated(made.camera, exact, 3, PointLoss::kHuber);
  EXPECT_LT(eliminated.Follow(made.poses), 1e-9);
  eliminated.Accept();
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  eliminated.Linearize(hessian, gradient);
  // All cameras move by the same vector. If the points follow, the cost is zero.
  Eigen::VectorXd together(18);
  for (size_t i = 0; i < made.poses.size(); ++i) {
    together.segment<6>(6 * static_cast<Eigen::Index>(i)) << Eigen::Vector3d::Zero(),
        made.poses[i].rotation * Eigen::Vector3d(1.0, 2.0, 3.0);
  }
  const Eigen::MatrixXd whole = hessian.selfadjointView<Eigen::Lower>();
  EXPECT_LT(together.dot(whole * together), 1e-6 * whole.trace());
}

// A single view without depth leaves the distance free.
TEST(EliminatedPoints, APointInASingleViewWithoutDepthStaysFinite) {
  MadePoints made(1, 1);
  made.points = {};
  made.points.AddPoint({0.1, 0.2, 3.0});
  made.points.AddView({.measured = {330.0, 260.0, 0.0}, .inverse_sigma = {1.0, 1.0, 0.0}}, 0);
  EliminatedPoints eliminated(made.camera, made.points, 1, PointLoss::kHuber);
  EXPECT_LT(Settle(eliminated, made.poses), 1e-6);
  EXPECT_LT((made.points.positions()[0] - Eigen::Vector3d(0.1, 0.2, 3.0)).norm(), 0.5);
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  eliminated.Linearize(hessian, gradient);
  EXPECT_TRUE(hessian.allFinite());
  EXPECT_TRUE(gradient.allFinite());
}

// On the optical axis the distance is exactly free.
TEST(EliminatedPoints, APointOnTheOpticalAxisOfASingleViewStaysFinite) {
  MadePoints made(1, 1);
  made.poses = {Rigid3()};
  made.points = {};
  made.points.AddPoint({0.0, 0.0, 3.0});
  made.points.AddView({.measured = {321.0, 240.0, 0.0}, .inverse_sigma = {1.0, 1.0, 0.0}}, 0);
  EliminatedPoints eliminated(made.camera, made.points, 1, PointLoss::kNone);
  EXPECT_LT(eliminated.Follow(made.poses), 1e-9);
  EXPECT_LT((made.points.positions()[0] - Eigen::Vector3d(0.0, 0.0, 3.0)).norm(), 0.1);
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  eliminated.Linearize(hessian, gradient);
  EXPECT_TRUE(hessian.allFinite());
  EXPECT_TRUE(gradient.allFinite());
}

// Two cameras side by side see a point between them, which starts too far away by the factor
// `ratio`. The disparity is linear in the inverse of the distance, so an undamped step leads to a
// point behind the cameras. A step succeeds if its damping is above about `ratio`. The true
// distance is 0.02 m.
class FarPoint {
 public:
  explicit FarPoint(double ratio, double sigma = 1.0) {
    const Eigen::Vector3d truth(0.5, 0.0, 0.02);
    points.AddPoint({0.5, 0.0, 0.02 * ratio});
    for (size_t i = 0; i < poses.size(); ++i) {
      const Eigen::Vector3d image = ProjectRgbd(camera, poses[i] * truth);
      points.AddView({.measured = image, .inverse_sigma = {1.0 / sigma, 1.0 / sigma, 0.0}}, i);
    }
  }
  double Cost() {
    double cost = 0.0;
    for (const BundlePoints::PointObservation& observation : points.ObservationsOf(0)) {
      cost += 0.5 * PointResidual(camera, observation.measurement,
                                  poses[observation.pose] * points.positions()[0])
                        .squaredNorm();
    }
    return cost;
  }

  const PinholeCamera camera = MadePoints(1, 1).camera;
  const std::vector<Rigid3> poses = {
      Rigid3(), Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-1.0, 0.0, 0.0))};
  BundlePoints points;
};

// The damping of three trials is 1e-8, 0.01 and 1. It is kept for the next poses and grows on.
TEST(EliminatedPoints, AStepIsTriedThreeTimesWithMoreDamping) {
  for (const double ratio : {50.0, 5000.0}) {
    FarPoint made(ratio);
    EliminatedPoints eliminated(made.camera, made.points, 2, PointLoss::kNone, {.steps = 1});
    const double cost = made.Cost();
    EXPECT_NEAR(eliminated.Follow(made.poses), cost, 1e-9 * cost) << ratio;
    EXPECT_LT(eliminated.Follow(made.poses), (1.0 - 1e-5) * cost) << ratio;
  }
}

// A point that is held by its damping holds the cameras that see it. Without damping, a single
// camera could move sideways and the point with it, because its distance is free.
TEST(EliminatedPoints, TheSystemIsDampedLikeTheSteps) {
  FarPoint made(50.0);
  EliminatedPoints eliminated(made.camera, made.points, 2, PointLoss::kNone, {.steps = 1});
  eliminated.Follow(made.poses);  // the damping is 100 now
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  eliminated.Linearize(hessian, gradient);
  const double of_camera = made.camera.fx * made.camera.fx;  // at a distance of 1 m
  EXPECT_NEAR(hessian(3, 3), of_camera * (1.0 - 1.0 / 101.0), 1e-6 * of_camera);
}

// After a success the damping falls to a tenth, not at once.
TEST(EliminatedPoints, TheDampingIsRemembered) {
  FarPoint made(5000.0);
  EliminatedPoints eliminated(made.camera, made.points, 2, PointLoss::kNone, {.steps = 1});
  int count = 0;
  for (; count < 300 && eliminated.Follow(made.poses) > 1e-9; ++count) {
    eliminated.Accept();
  }
  EXPECT_LT(count, 45);
}

TEST(EliminatedPoints, EveryFollowBeginsAtTheAcceptedPositions) {
  MadePoints made(5);
  MadePoints same(5);
  std::vector<Rigid3> others = made.poses;
  for (Rigid3& pose : others) {
    pose.translation += Eigen::Vector3d(0.3, 0.0, 0.3);
  }
  EliminatedPoints twice(made.camera, made.points, 5, PointLoss::kNone, {.steps = 1});
  EliminatedPoints once(same.camera, same.points, 5, PointLoss::kNone, {.steps = 1});
  twice.Follow(others);
  const double expected = once.Follow(same.poses);
  EXPECT_NEAR(twice.Follow(made.poses), expected, 0.05 * expected);
}

// A cost far below 1 is worth it too.
TEST(EliminatedPoints, AStepThatFailsIsDampedAlsoIfTheCostIsSmall) {
  FarPoint made(50.0, 1e6);
  EliminatedPoints eliminated(made.camera, made.points, 2, PointLoss::kNone, {.steps = 1});
  ASSERT_LT(made.Cost(), 5e-4);
  eliminated.Follow(made.poses);
  EXPECT_LT(eliminated.Follow(made.poses), 0.99 * made.Cost());
}

TEST(EliminatedPoints, TheDampingFallsAgain) {
  FarPoint made(50.0);
  EliminatedPoints eliminated(made.camera, made.points, 2, PointLoss::kNone, {.steps = 1});
  EXPECT_LT(Settle(eliminated, made.poses), 1e-12);
  EXPECT_NEAR(made.points.positions()[0].z(), 0.02, 1e-9);
}

TEST(EliminatedPoints, AnotherStepMustBeWorthwhile) {
  const auto cost_with = [&](const FollowOptions& options) {
    MadePoints made(5);
    for (Eigen::Vector3d& position : made.points.positions()) {
      position *= 1.5;
    }
    return EliminatedPoints(made.camera, made.points, 5, PointLoss::kNone, options)
        .Follow(made.poses);
  };
  EXPECT_EQ(cost_with({.steps = 10, .worthwhile = 1e12}), cost_with({.steps = 1}));
  EXPECT_LT(cost_with({.steps = 10, .worthwhile = 0.0}), 0.9 * cost_with({.steps = 1}));
}

}  // namespace
}  // namespace hullslam::internal

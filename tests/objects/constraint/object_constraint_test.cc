// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/constraint/object_constraint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "costs/object_cost_laws.h"
#include "objects/made_objects.h"
#include "support/test_cameras.h"

namespace hullslam {
namespace {

// Three lines that the ellipse of SphereAhead (x from -55 to 695) misses by 0, 1 and 16 px, and a
// point of the optical axis 0.3 m before its surface at z = 0.4 m.
class ObjectConstraintTest : public ::testing::Test {
 protected:
  ObjectConstraintTest() {
    detection_.lines = {{{{1.0, 0.0}, -695.0}, false},
                        {{{1.0, 0.0}, -694.0}, false},
                        {{{-1.0, 0.0}, -71.0}, false}};
    detection_.points = std::vector<Eigen::Vector3d>(6, {0.0, 0.0, 0.1});
    options_.sigma_px = 2.0;
    options_.misfit_factor = 0.0;
    options_.loss = RobustLoss::kNone;
    options_.depth.max_points = 6;
    options_.depth.loss = RobustLoss::kNone;
  }
  ObjectConstraint Make() const {
    return MakeObjectConstraint(kObjectCamera, {KeyframeId(), Rigid3(), &detection_},
                                detection_.lines, SphereAhead().ellipsoid, misfit_px_, options_);
  }
  // The contribution of the line that is 16 px off to the sum.
  double WorstSquare() const {
    const double worst = ObjectResidualsOf(*Make().silhouette, SphereAhead())[2];
    return worst * worst;
  }

  Detection detection_;
  double misfit_px_ = 0.0;
  ObjectConstraintOptions options_;
};

TEST_F(ObjectConstraintTest, ByHandWithoutLoss) {
  const ObjectConstraint constraint = Make();
  const Eigen::VectorXd silhouette = ObjectResidualsOf(*constraint.silhouette, SphereAhead());
  ASSERT_EQ(silhouette.size(), 3);
  EXPECT_NEAR(silhouette[0], 0.0, 1e-9);
  EXPECT_NEAR(silhouette[1], 0.5, 1e-9);
  EXPECT_NEAR(silhouette[2], -8.0, 1e-9);
  // 0.3 m at 0.1 m are 3 sigmas; six points count as one.
  const Eigen::VectorXd depth = ObjectResidualsOf(*constraint.depth, SphereAhead());
  ASSERT_EQ(depth.size(), 6);
  EXPECT_NEAR(depth[0], 3.0 / std::sqrt(6.0), 1e-7);
}

TEST_F(ObjectConstraintTest, TheSigmaMayBeInTheUnitOfTheResidual) {
  options_.sigma_unit = SigmaUnit::kResidual;
  options_.misfit_factor = 1.0;
  misfit_px_ = 3.0;  // does not count
  const Eigen::VectorXd silhouette = ObjectResidualsOf(*Make().silhouette, SphereAhead());
  EXPECT_NEAR(silhouette[2], -8.0, 1e-9) << "for tangent, the unit is the pixel anyway";
  options_.residual = ObjectResidual::kAlgebraicPlane;
  const double with_sigma_2 = ObjectResidualsOf(*Make().silhouette, SphereAhead())[2];
  options_.sigma_px = 4.0;
  EXPECT_NEAR(2.0 * ObjectResidualsOf(*Make().silhouette, SphereAhead())[2], with_sigma_2, 1e-12);
}

// The sigma of landmarks is a share of their distance, here half of 0.1 m.
TEST_F(ObjectConstraintTest, LandmarksReplaceDepthPoints) {
  const std::vector<Eigen::Vector3d> points = detection_.points.Unpack();
  detection_.points.clear();
  EXPECT_EQ(Make().depth, nullptr);
  options_.depth.landmark_sigma = 0.5;
  const ResolvedObservation observation{KeyframeId(), Rigid3(), &detection_, points};
  const ObjectConstraint constraint = MakeObjectConstraint(
      kObjectCamera, observation, detection_.lines, SphereAhead().ellipsoid, 0.0, options_);
  const Eigen::VectorXd depth = ObjectResidualsOf(*constraint.depth, SphereAhead());
  ASSERT_EQ(depth.size(), 6);
  EXPECT_NEAR(depth[0], 0.3 / (0.5 * 0.1) / std::sqrt(6.0), 1e-6);
}

TEST_F(ObjectConstraintTest, TheMisfitAddsToTheSigma) {
  options_.misfit_factor = 0.5;
  misfit_px_ = 3.0;
  EXPECT_NEAR(WorstSquare(), 256.0 / (2.0 * 2.0 + 1.5 * 1.5), 1e-9);
}

TEST_F(ObjectConstraintTest, LinesOfTheRightImageAreMoreRows) {
  const auto make = [&](std::span<const SilhouetteLine> right_lines) {
    const ObjectConstraint constraint =
        MakeObjectConstraint(kObjectCamera, {KeyframeId(), Rigid3(), &detection_}, detection_.lines,
                             SphereAhead().ellipsoid, misfit_px_, options_, right_lines);
    return ObjectResidualsOf(*constraint.silhouette, SphereAhead());
  };
  const Eigen::VectorXd one = make({});
  const Eigen::VectorXd both = make(detection_.lines);
  ASSERT_EQ(one.size(), 3);
  ASSERT_EQ(both.size(), 6);
  EXPECT_TRUE(both.head<3>().isApprox(one, 1e-12));
  EXPECT_GT((both.tail<3>() - one).cwiseAbs().minCoeff(), 0.1) << "the right camera is elsewhere";
}

TEST_F(ObjectConstraintTest, LinesCountAsALimitedNumber) {
  options_.max_effective_lines = 3.0;
  EXPECT_NEAR(WorstSquare(), 64.0, 1e-9);
  options_.max_effective_lines = 1.5;
  EXPECT_NEAR(WorstSquare(), 32.0, 1e-9);
}

// The formulas of the losses at 8 sigmas.
TEST_F(ObjectConstraintTest, EachLossByHand) {
  options_.loss_scale = 4.0;
  options_.loss = RobustLoss::kHuber;
  EXPECT_NEAR(WorstSquare(), 2.0 * 4.0 * 8.0 - 16.0, 1e-9);
  options_.loss = RobustLoss::kCauchy;
  EXPECT_NEAR(WorstSquare(), 16.0 * std::log(5.0), 1e-9);
  options_.loss = RobustLoss::kTukey;
  EXPECT_NEAR(WorstSquare(), 16.0 / 3.0, 1e-9);  // the loss does not grow beyond its scale
  options_.loss_scale = 8.01;
  EXPECT_GT(WorstSquare(), 16.0 / 3.0);
}

TEST_F(ObjectConstraintTest, TheLossScaleHasALeastNumberOfPixels) {
  options_.loss = RobustLoss::kHuber;
  options_.loss_scale = 4.0;
  options_.min_loss_px = 7.9;  // less than 4 sigmas of 2 px
  EXPECT_NEAR(WorstSquare(), 48.0, 1e-9);
  options_.min_loss_px = 16.1;
  EXPECT_NEAR(WorstSquare(), 64.0, 1e-9);
}

TEST_F(ObjectConstraintTest, DepthHasALossAndANumberOfPointsOfItsOwn) {
  options_.depth.loss = RobustLoss::kCauchy;
  options_.depth.loss_scale = 1.0;
  options_.depth.sigma = 0.15;  // two sigmas
  options_.depth.max_points = 2;
  options_.depth.max_effective_points = 2.0;
  const Eigen::VectorXd depth = ObjectResidualsOf(*Make().depth, SphereAhead());
  ASSERT_EQ(depth.size(), 2);
  EXPECT_NEAR(depth.squaredNorm(), 2.0 * std::log(5.0), 1e-7);
  options_.depth.max_points = 5;
  EXPECT_EQ(Make().depth->num_residuals(), 5);
  options_.depth.choice = PointChoice::kEveryKth;  // takes every second of six points
  EXPECT_EQ(Make().depth->num_residuals(), 3);
  options_.depth.max_points = 0;
  EXPECT_EQ(Make().depth, nullptr);
}

TEST_F(ObjectConstraintTest, IsNullIfTheDetectionLacksItsData) {
  options_.residual = ObjectResidual::kAlgebraicPoint;  // not of support lines
  EXPECT_EQ(Make().silhouette, nullptr);
  options_.residual = ObjectResidual::kTangent;
  detection_.lines.clear();
  detection_.points.clear();
  EXPECT_EQ(Make().silhouette, nullptr);
  EXPECT_EQ(Make().depth, nullptr);
}

TEST_F(ObjectConstraintTest, AnObjectBehindTheCameraHasNoOutline) {
  Ellipsoid behind = SphereAhead().ellipsoid;
  behind.world_from_object.translation.z() = -3.0;
  const ObjectConstraint constraint =
      MakeObjectConstraint(kObjectCamera, {KeyframeId(), Rigid3(), &detection_}, detection_.lines,
                           behind, 0.0, options_);
  EXPECT_EQ(constraint.silhouette, nullptr);
}

// All lines lie 20 px outside and all points 1 m from the centre, so that no difference straddles
// the bend of a loss.
TEST_F(ObjectConstraintTest, HasTrueDerivatives) {
  RandomGeometry random(1);
  for (const RobustLoss loss :
       {RobustLoss::kNone, RobustLoss::kHuber, RobustLoss::kCauchy, RobustLoss::kTukey}) {
    options_.loss = loss;
    options_.loss_scale = loss == RobustLoss::kTukey ? 30.0 : 2.5;
    options_.depth.loss = loss;
    options_.depth.loss_scale = options_.loss_scale;
    for (int i = 0; i < 5; ++i) {
      const SeenEllipsoid state = RandomSeenEllipsoid(random);
      detection_.lines = TangentsOf(state, 12);
      for (SilhouetteLine& line : detection_.lines) {
        line.line.offset -= 20.0;
      }
      std::vector<Eigen::Vector3d> points;
      for (int k = 0; k < 6; ++k) {
        points.push_back(state.cam_from_world * state.ellipsoid.world_from_object.translation +
                         random.Vector(1.0).normalized());
      }
      detection_.points = points;
      const ObjectConstraint constraint =
          MakeObjectConstraint(kObjectCamera, {KeyframeId(), state.cam_from_world, &detection_},
                               detection_.lines, state.ellipsoid, 0.0, options_);
      ExpectTrueObjectGradient(*constraint.silhouette, state);
      ExpectTrueObjectGradient(*constraint.depth, state);
    }
  }
}

class ObjectConstraintWith : public ::testing::TestWithParam<TestCamera> {};

HULLSLAM_WITH_ALL_CAMERAS(ObjectConstraintWith);

TEST_P(ObjectConstraintWith, TheResidualOfALineIsItsDistanceInTheImageAsRead) {
  constexpr double kMove = 0.2;  // px
  const Sensor& sensor = GetParam().sensor;
  const MadeObject object = MakeObject("cup", {0.9, 0.4, 1.0}, {0.05, 0.06, 0.07}, 0.5);
  Detection detection = Detect(object, sensor, Rigid3());
  const Ellipse ellipse =
      ProjectEllipsoid(sensor.camera.Matrix(), Rigid3(), object.ellipsoid).value();
  detection.lines.resize(4);
  for (SilhouetteLine& line : detection.lines) {
    line.line = MovedInImage(sensor, ellipse, line.line, kMove);
  }
  ObjectConstraintOptions options;
  options.sigma_px = 1.0;
  options.misfit_factor = 0.0;
  options.loss = RobustLoss::kNone;
  const ObjectConstraint constraint =
      MakeObjectConstraint(sensor.camera, {KeyframeId(), Rigid3(), &detection}, detection.lines,
                           object.ellipsoid, 0.0, options);
  SeenEllipsoid state;
  state.ellipsoid = object.ellipsoid;
  const Eigen::VectorXd residuals = ObjectResidualsOf(*constraint.silhouette, state);
  ASSERT_EQ(residuals.size(), 4);
  for (const double residual : residuals) {
    EXPECT_NEAR(std::abs(residual), kMove, 0.04 * kMove);
  }
}

TEST(ObjectPrior, DependsOnDepth) {
  ObjectConstraintOptions options;
  options.prior.log_axes = 0.5;
  options.prior_without_depth.log_axes = 0.1;
  const ObjectBlocks start(SphereAhead());
  ObjectBlocks blocks = start;
  blocks.log_axes.x() += 0.2;
  const double* parameters[] = {blocks.object.data(), blocks.log_axes.data()};
  Eigen::Matrix<double, 9, 1> residuals;
  for (const auto& [has_depth, expected] : {std::pair(true, 0.4), {false, 2.0}}) {
    const auto prior = MakeObjectPrior(SphereAhead().ellipsoid, has_depth, options);
    ASSERT_TRUE(prior->Evaluate(parameters, residuals.data(), nullptr));
    EXPECT_NEAR(residuals[0], expected, 1e-12);
  }
}

}  // namespace
}  // namespace hullslam

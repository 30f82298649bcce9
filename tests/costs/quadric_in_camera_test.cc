// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/quadric_in_camera.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "costs/object_cost_laws.h"

namespace hullslam {
namespace {

// A cost on simple functions of the quadric, so that WriteRow is checked alone.
class StateCost final : public ObjectCost {
 public:
  explicit StateCost(const Eigen::Vector3d& direction) : ObjectCost(2), direction_(direction) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const QuadricInCamera quadric(parameters);
    const Eigen::Vector3d square = quadric.square() * direction_;
    residuals[0] = direction_.dot(quadric.center());
    residuals[1] = direction_.dot(square);
    if (jacobians != nullptr) {
      ByObjectInCamera derivative = ByObjectInCamera::Zero();
      derivative.segment<3>(3) = direction_.transpose();
      quadric.WriteRow(0, derivative, jacobians);
      derivative << 2.0 * square.cross(direction_).transpose(), 0.0, 0.0, 0.0,
          2.0 * (quadric.axes().transpose() * direction_).cwiseAbs2().transpose();
      quadric.WriteRow(1, derivative, jacobians);
    }
    return true;
  }

 private:
  Eigen::Vector3d direction_;
};

TEST(QuadricInCamera, ByHand) {
  // The camera is rotated by 90 degrees about z relative to the object, so the long axis of the
  // object is along the camera's y axis.
  SeenEllipsoid state;
  state.cam_from_world = {ExpSo3({0.0, 0.0, std::numbers::pi / 2.0}), {1.0, 0.0, 0.0}};
  state.ellipsoid.world_from_object.translation = {0.0, 2.0, 3.0};
  state.ellipsoid.half_axes = {0.5, 0.2, 0.1};
  const ObjectBlocks blocks(state);
  const QuadricInCamera quadric(blocks.Pointers().data());
  EXPECT_LT((quadric.center() - Eigen::Vector3d(-1.0, 0.0, 3.0)).norm(), 1e-12);
  EXPECT_LT((quadric.axes().col(0) - Eigen::Vector3d(0.0, 0.5, 0.0)).norm(), 1e-12);
  EXPECT_LT((quadric.square().diagonal() - Eigen::Vector3d(0.04, 0.25, 0.01)).norm(), 1e-12);
}

TEST(QuadricInCamera, ChainOfDerivativesIsTrue) {
  RandomGeometry random(1);
  for (int i = 0; i < 20; ++i) {
    const StateCost cost(random.Vector(1.0));
    ExpectObjectCostLaws(cost, RandomSeenEllipsoid(random), random);
  }
}

TEST(QuadricInCamera, NullJacobiansAreSkipped) {
  RandomGeometry random(2);
  const ObjectBlocks blocks(RandomSeenEllipsoid(random));
  const QuadricInCamera quadric(blocks.Pointers().data());
  double* jacobians[] = {nullptr, nullptr, nullptr};
  quadric.WriteRow(0, ByObjectInCamera::Ones(), jacobians);
  Eigen::Vector3d by_log_axes = Eigen::Vector3d::Zero();
  jacobians[2] = by_log_axes.data();
  quadric.WriteRow(0, ByObjectInCamera::Ones(), jacobians);
  EXPECT_EQ(by_log_axes, Eigen::Vector3d::Ones());
}

TEST(QuadricInCamera, IsInFrontIfTheWholeEllipsoidIs) {
  for (const auto& [z, expected] :
       {std::pair(-2.0, false), {0.0, false}, {0.59, false}, {0.6, false}, {0.61, true}}) {
    SeenEllipsoid state = SphereAhead();
    state.ellipsoid.world_from_object.translation.z() = z;
    const ObjectBlocks blocks(state);
    EXPECT_EQ(QuadricInCamera(blocks.Pointers().data()).IsInFront(), expected) << z;
  }
  SeenEllipsoid broken = SphereAhead();
  broken.ellipsoid.world_from_object.translation.x() = std::numeric_limits<double>::quiet_NaN();
  const ObjectBlocks blocks(broken);
  EXPECT_FALSE(QuadricInCamera(blocks.Pointers().data()).IsInFront());
}

}  // namespace
}  // namespace hullslam

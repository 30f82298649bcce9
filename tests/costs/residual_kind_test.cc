// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/residual_kind.h"

#include <gtest/gtest.h>

#include <cmath>

#include "costs/object_cost_laws.h"

namespace hullslam {
namespace {

class MakeObjectCostTest : public ::testing::Test {
 protected:
  MakeObjectCostTest() {
    detection_.lines = TangentsOf(state_, 10);
    detection_.contour = contour_;
    detection_.hull = contour_;
    detection_.ellipse = FitEllipse(contour_);
    detection_.box = detection_.ellipse->Bounds();
  }
  std::unique_ptr<ceres::CostFunction> Make(ObjectResidual residual, ObjectPrimitive primitive,
                                            double sigma = 1.0) {
    detection_.primitive = primitive;
    return MakeObjectCost(residual, kObjectCamera, detection_, detection_.lines, sigma);
  }

  RandomGeometry random_{1};
  SeenEllipsoid state_ = RandomSeenEllipsoid(random_);
  std::vector<Eigen::Vector2d> contour_ = ContourOf(state_, 200);
  Detection detection_;
};

TEST_F(MakeObjectCostTest, MakesTheAcceptedCombinationsOnly) {
  for (const ObjectResidual residual : AllResiduals()) {
    for (const ObjectPrimitive primitive : kAllPrimitives) {
      EXPECT_EQ(Make(residual, primitive) != nullptr, AcceptsPrimitive(residual, primitive))
          << NameOf(residual) << " " << NameOf(primitive);
    }
  }
}

// The measured outline is the projected ellipse, so all residuals are zero, or nearly zero where a
// polygon with a slightly smaller area stands for the ellipse.
TEST_F(MakeObjectCostTest, AllResidualsAreSmallAtTheTruth) {
  for (const ObjectResidual residual : AllResiduals()) {
    for (const ObjectPrimitive primitive : kAllPrimitives) {
      if (const auto cost = Make(residual, primitive)) {
        EXPECT_LT(ObjectResidualsOf(*cost, state_).cwiseAbs().maxCoeff(), 5e-3)
            << NameOf(residual) << " " << NameOf(primitive);
      }
    }
  }
}

TEST_F(MakeObjectCostTest, OneRowALineOrAPoint) {
  EXPECT_EQ(Make(ObjectResidual::kTangent, ObjectPrimitive::kSupport)->num_residuals(), 10);
  EXPECT_EQ(Make(ObjectResidual::kAlgebraicPlane, ObjectPrimitive::kHull)->num_residuals(), 10);
  EXPECT_EQ(Make(ObjectResidual::kAlgebraicPoint, ObjectPrimitive::kContour)->num_residuals(), 64);
  EXPECT_EQ(Make(ObjectResidual::kDistribution, ObjectPrimitive::kConic)->num_residuals(), 1);
  EXPECT_EQ(Make(ObjectResidual::kOverlap, ObjectPrimitive::kBox)->num_residuals(), 1);
  contour_.resize(10);
  detection_.contour = contour_;
  EXPECT_EQ(Make(ObjectResidual::kAlgebraicPoint, ObjectPrimitive::kContour)->num_residuals(), 10);
}

TEST_F(MakeObjectCostTest, SigmaDividesTheResidual) {
  SeenEllipsoid moved = state_;
  moved.ellipsoid.half_axes *= 1.1;
  for (const ObjectResidual residual : AllResiduals()) {
    for (const ObjectPrimitive primitive : kAllPrimitives) {
      if (const auto cost = Make(residual, primitive)) {
        const auto scaled = Make(residual, primitive, 4.0);
        const Eigen::VectorXd residuals = ObjectResidualsOf(*cost, moved);
        EXPECT_GT(residuals.norm(), 0.0);
        EXPECT_LT((4.0 * ObjectResidualsOf(*scaled, moved) - residuals).norm(),
                  1e-12 * residuals.norm());
      }
    }
  }
}

// A world that is s times as large has the same images, so it must have the same cost. The literal
// constraint of Yu et al. is the only one that breaks this law: its residual is in m^2, so it grows
// with s^2.
TEST_F(MakeObjectCostTest, TheScaleOfTheWorldDoesNotMatter) {
  SeenEllipsoid moved = state_;
  moved.ellipsoid.half_axes *= 1.1;
  moved.cam_from_world.translation.x() += 0.05;
  for (const ObjectResidual residual : AllResiduals()) {
    for (const ObjectPrimitive primitive : kAllPrimitives) {
      const auto cost = Make(residual, primitive, 0.7);
      if (cost == nullptr) {
        continue;
      }
      const Eigen::VectorXd residuals = ObjectResidualsOf(*cost, moved);
      ASSERT_GT(residuals.norm(), 0.0);
      for (const double scale : {0.5, 0.99, 3.0}) {
        const double factor = residual == ObjectResidual::kAlgebraicPlane ? scale * scale : 1.0;
        EXPECT_LT((ObjectResidualsOf(*cost, ScaledWorld(moved, scale)) - factor * residuals).norm(),
                  1e-7 * residuals.norm())
            << NameOf(residual) << " " << NameOf(primitive) << " " << scale;
      }
    }
  }
}

TEST_F(MakeObjectCostTest, TakesTheLinesThatAreGiven) {
  const auto cost = MakeObjectCost(ObjectResidual::kTangent, kObjectCamera, detection_,
                                   std::span(detection_.lines).first(3), 1.0);
  EXPECT_EQ(cost->num_residuals(), 3);
}

TEST_F(MakeObjectCostTest, IsNullForAnEmptyDetection) {
  detection_ = {};
  for (const ObjectResidual residual : AllResiduals()) {
    for (const ObjectPrimitive primitive : kAllPrimitives) {
      EXPECT_EQ(Make(residual, primitive), nullptr);
    }
  }
}

}  // namespace

}  // namespace hullslam

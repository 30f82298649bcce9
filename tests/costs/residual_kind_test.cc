// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/residual_kind.h"

#include <gtest/gtest.h>

#include <algorithm>
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

// A small, distant sphere. The radius of its projection is r = 500 * 0.2 / sqrt(25 - 0.04) px.
SeenEllipsoid SmallSphere() {
  SeenEllipsoid state;
  state.ellipsoid.world_from_object.translation = {0.0, 0.0, 5.0};
  state.ellipsoid.half_axes.setConstant(0.2);
  return state;
}

constexpr PinholeCamera kSquare{.fx = 500.0, .fy = 500.0, .cx = 320.0, .cy = 240.0, .bf = 40.0};

double SizeOf(ObjectResidual residual, double error_px) {
  const SeenEllipsoid state = SmallSphere();
  return ResidualOfPixelError(residual, kSquare, state.cam_from_world, state.ellipsoid, error_px)
      .value();
}

TEST(ResidualOfPixelError, ByHand) {
  const double radius = 100.0 / std::sqrt(25.0 - 0.04);
  EXPECT_NEAR(SizeOf(ObjectResidual::kAlgebraicPlane, 1.5), 2.0 * radius * 1.5 * 1e-4, 1e-12);
  EXPECT_NEAR(SizeOf(ObjectResidual::kRelativePlane, 1.5), 2.0 * radius * 1.5 / 250000.0, 1e-12);
  EXPECT_NEAR(SizeOf(ObjectResidual::kAlgebraicPoint, 1.5), 3.0 / radius, 1e-12);
}

// The mean residual of the sphere if this ellipse is measured.
double MeanResidual(ObjectResidual residual, const Ellipse& measured) {
  Detection detection;
  detection.primitive = KindOf(residual).primitives.front();
  detection.hull = measured.Polygon(720);
  detection.contour = detection.hull;
  detection.ellipse = measured;
  detection.box = measured.Bounds();
  for (const Eigen::Vector2d& normal : {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.6, 0.8)}) {
    const double offset = -normal.dot(measured.center) - measured.HalfExtent(normal);
    detection.lines.push_back({{normal, offset}, false});
  }
  const auto cost = MakeObjectCost(residual, kSquare, detection, detection.lines, 1.0);
  return ObjectResidualsOf(*cost, SmallSphere()).cwiseAbs().mean();
}

// The result agrees with the residuals of an outline that is larger by this error or, for a
// residual that compares two ellipses, is shifted by it.
TEST(ResidualOfPixelError, IsTheSizeOfTheResiduals) {
  const double radius = 100.0 / std::sqrt(25.0 - 0.04);
  const double error_px = 0.2;
  Ellipse larger;
  larger.center = {320.0, 240.0};
  larger.shape = (radius + error_px) * (radius + error_px) * Eigen::Matrix2d::Identity();
  Ellipse shifted;
  shifted.center = {320.0 + error_px, 240.0};
  shifted.shape = radius * radius * Eigen::Matrix2d::Identity();
  for (const ObjectResidual residual : AllResiduals()) {
    const double size = SizeOf(residual, error_px);
    EXPECT_LT(std::min(std::abs(MeanResidual(residual, larger) / size - 1.0),
                       std::abs(MeanResidual(residual, shifted) / size - 1.0)),
              0.03)
        << NameOf(residual);
  }
}

TEST(ResidualOfPixelError, IsNothingUnlessInFront) {
  SeenEllipsoid state = SmallSphere();
  for (const double z : {-5.0, 0.0, 0.2}) {
    state.ellipsoid.world_from_object.translation.z() = z;
    EXPECT_FALSE(ResidualOfPixelError(ObjectResidual::kTangent, kSquare, state.cam_from_world,
                                      state.ellipsoid, 1.0)
                     .has_value())
        << z;
  }
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "costs/object_cost_laws.h"
#include "costs/residual_kind.h"

namespace hullslam {
namespace {

class FilteredPoint : public ::testing::Test {
 protected:
  FilteredPoint() {
    detection_.primitive = ObjectPrimitive::kContour;
    detection_.contour = contour_;
  }
  std::unique_ptr<ceres::CostFunction> Make(const std::optional<Ellipse>& projected,
                                            double sigma = 0.02) {
    return MakeObjectCost(ObjectResidual::kFilteredPoint, kObjectCamera, detection_, {}, sigma,
                          projected);
  }
  // Moves the first points of the contour by 30 px.
  void Spoil(size_t count) {
    std::vector<Eigen::Vector2d> spoilt = contour_;
    for (size_t i = 0; i < count; ++i) {
      spoilt[i] += Eigen::Vector2d(30.0, 30.0);
    }
    detection_.contour = spoilt;
  }

  RandomGeometry random_{4};
  SeenEllipsoid state_ = RandomSeenEllipsoid(random_);
  std::vector<Eigen::Vector2d> contour_ = ContourOf(state_, 60);
  Detection detection_;
  std::optional<Ellipse> ellipse_ = FitEllipse(contour_);
};

TEST_F(FilteredPoint, LeavesOutPointsThatDoNotFitToTheProjectedEllipse) {
  Spoil(10);
  const auto cost = Make(ellipse_);
  EXPECT_LE(cost->num_residuals(), 52);  // the ellipse may pass by two of the moved points
  EXPECT_GE(cost->num_residuals(), 50);
  EXPECT_LT(ObjectResidualsOf(*cost, state_).head(1).norm(), 3.0);
}

TEST_F(FilteredPoint, UsesAllPointsIfTheProjectedEllipseFitsToFew) {
  Ellipse elsewhere = *ellipse_;
  elsewhere.center += Eigen::Vector2d(400.0, 0.0);
  EXPECT_EQ(Make(elsewhere)->num_residuals(), 60);
}

TEST_F(FilteredPoint, WithoutAProjectedEllipseItIsAlgebraicPoint) {
  Spoil(10);
  const auto all =
      MakeObjectCost(ObjectResidual::kAlgebraicPoint, kObjectCamera, detection_, {}, 0.02);
  EXPECT_EQ(ObjectResidualsOf(*Make(std::nullopt), state_), ObjectResidualsOf(*all, state_));
}

TEST_F(FilteredPoint, KeepsTheLaws) { ExpectObjectCostLaws(*Make(ellipse_), state_, random_); }

TEST_F(FilteredPoint, HasItsRowInTheTable) {
  ExpectKind(ObjectResidual::kFilteredPoint, "filtered_point", false, {ObjectPrimitive::kContour});
  EXPECT_TRUE(NeedsProjection(ObjectResidual::kFilteredPoint));
  EXPECT_FALSE(NeedsProjection(ObjectResidual::kAlgebraicPoint));
  EXPECT_NEAR(SizeOfSomeError(ObjectResidual::kFilteredPoint), 3.0 / 20.0, 1e-12);
}

}  // namespace
}  // namespace hullslam

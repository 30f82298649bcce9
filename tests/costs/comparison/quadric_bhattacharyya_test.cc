// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "costs/object_cost_laws.h"
#include "costs/residual_kind.h"

namespace hullslam {
namespace {

// The projected ellipse of SphereAhead has the half axes 375 and 300 px and the centre (320, 240).
Detection DetectionOf(const Ellipse& ellipse) {
  Detection detection;
  detection.primitive = ObjectPrimitive::kConic;
  detection.ellipse = ellipse;
  return detection;
}

TEST(BhattacharyyaResidual, ByHand) {
  Ellipse measured;
  measured.center = {320.0 + 375.0, 240.0};
  measured.shape = Eigen::Vector2d(375.0 * 375.0, 300.0 * 300.0).asDiagonal();
  const auto cost =
      MakeObjectCost(ObjectResidual::kBhattacharyya, kObjectCamera, DetectionOf(measured), {}, 0.1);
  EXPECT_NEAR(ObjectResidualsOf(*cost, SphereAhead())[0], 10.0 / 8.0, 1e-8);
}

TEST(BhattacharyyaResidual, KeepsTheLaws) {
  RandomGeometry random(3);
  for (int i = 0; i < 20; ++i) {
    const std::optional<Ellipse> measured = FitEllipse(ContourOf(RandomSeenEllipsoid(random), 50));
    ASSERT_TRUE(measured);
    const auto cost = MakeObjectCost(ObjectResidual::kBhattacharyya, kObjectCamera,
                                     DetectionOf(*measured), {}, 0.2);
    ExpectObjectCostLaws(*cost, RandomSeenEllipsoid(random), random);
  }
}

TEST(BhattacharyyaResidual, DoesNotDependOnTheSizeInTheImage) {
  const ResidualKind& kind = KindOf(ObjectResidual::kBhattacharyya);
  const double near =
      kind.of_pixel_error(4.0, {.radius_px = 80.0, .depth = 5.0, .focal_px = 500.0});
  const double far = kind.of_pixel_error(1.0, {.radius_px = 20.0, .depth = 5.0, .focal_px = 500.0});
  EXPECT_NEAR(near, far, 1e-15);
}

TEST(BhattacharyyaResidual, HasItsRowInTheTable) {
  ExpectKind(ObjectResidual::kBhattacharyya, "bhattacharyya", false,
             {ObjectPrimitive::kConic, ObjectPrimitive::kBoxEllipse});
  EXPECT_NEAR(SizeOfSomeError(ObjectResidual::kBhattacharyya), 2.25 / 3200.0, 1e-12);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/refinement.h"

#include <gtest/gtest.h>

#include "objects/made_objects.h"
#include "objects/validity.h"

namespace hullslam {
namespace {

class RefinementTest : public ::testing::Test {
 protected:
  void Look(double step, int count) {
    id_ = map_.AddObject();
    for (int i = 0; i < count; ++i) {
      map_.AddObservation(
          id_, AddObserver(map_, sensor_, CameraOnCircle(step * i, 1.5, 0.5), {made_}), 0);
    }
  }
  std::vector<ResolvedObservation> Observations() const {
    return ResolveObservations(map_, map_.objects().At(id_));
  }
  // In one observation, the right side of the mask is 60 px too far to the right.
  std::vector<ResolvedObservation> ViewsWithABadMask() {
    bad_ = *map_.keyframes().At(KeyframeId(4)).frame;
    for (SilhouetteLine& line : bad_.detections[0].lines) {
      line.line.offset -= 60.0 * std::max(0.0, line.line.normal.x());
    }
    std::vector<ResolvedObservation> observations = Observations();
    observations[4].detection = &bad_.detections[0];
    return observations;
  }
  Ellipsoid Start() const {
    Ellipsoid start = made_.ellipsoid;
    start.world_from_object = {
        start.world_from_object.rotation * ExpSo3(Eigen::Vector3d(0.1, 0.05, -0.2)),
        start.world_from_object.translation + Eigen::Vector3d(0.02, -0.01, 0.015)};
    start.half_axes = start.half_axes.cwiseProduct(Eigen::Vector3d(1.2, 0.9, 1.15));
    return start;
  }
  Sensor sensor_ = MakeObjectSensor();
  MadeObject made_ = MakeObject("cup", {0.05, -0.1, 0.0}, {0.12, 0.08, 0.05}, 0.6);
  Map map_;
  ObjectId id_;
  Frame bad_;
};

double AxisError(const Ellipsoid& a, const Ellipsoid& b) {
  return (a.half_axes - b.half_axes).cwiseQuotient(b.half_axes).cwiseAbs().maxCoeff();
}

TEST_F(RefinementTest, FindsTheTruthFromManySides) {
  Look(0.3, 12);
  for (const ObjectResidual residual : {ObjectResidual::kTangent, ObjectResidual::kAlgebraicPlane,
                                        ObjectResidual::kRelativePlane}) {
    ObjectRefinementOptions options;
    options.constraint.residual = residual;
    options.constraint.prior.log_axes = 10.0;
    const Refinement refined =
        RefineEllipsoid(Start(), Start(), sensor_, Observations(), 5.0, options);
    ASSERT_TRUE(refined.is_usable);
    EXPECT_LT(AxisError(refined.ellipsoid, made_.ellipsoid), 0.02) << NameOf(residual);
    EXPECT_LT((refined.ellipsoid.world_from_object.translation -
               made_.ellipsoid.world_from_object.translation)
                  .norm(),
              0.002)
        << NameOf(residual);
  }
}

TEST_F(RefinementTest, TheTruthStays) {
  Look(0.3, 8);
  const Refinement refined =
      RefineEllipsoid(made_.ellipsoid, made_.ellipsoid, sensor_, Observations(), 5.0, {});
  ASSERT_TRUE(refined.is_usable);
  EXPECT_LT(AxisError(refined.ellipsoid, made_.ellipsoid), 1e-4);
  EXPECT_NEAR(refined.cost, 0.0, 1e-6);
}

TEST_F(RefinementTest, WithASmallAngleDepthAndPriorConstrainTheFreeParameters) {
  Look(0.02, 4);
  const Refinement refined = RefineEllipsoid(Start(), Start(), sensor_, Observations(), 5.0, {});
  ASSERT_TRUE(refined.is_usable);
  EXPECT_LT(AxisError(refined.ellipsoid, made_.ellipsoid), 0.5);
  EXPECT_GT(MeanOverlap(refined.ellipsoid, sensor_, Observations()), 0.95);
}

TEST_F(RefinementTest, OneBadMaskAmongManyHasLittleInfluence) {
  Look(0.3, 12);
  const std::vector<ResolvedObservation> observations = ViewsWithABadMask();
  const Refinement refined =
      RefineEllipsoid(Start(), made_.ellipsoid, sensor_, observations, 5.0, {});
  ASSERT_TRUE(refined.is_usable);
  EXPECT_LT(AxisError(refined.ellipsoid, made_.ellipsoid), 0.1);
}

// The loss acts in standard deviations, so only the quotient of loss_px and max_misfit_px counts if
// the misfit itself is not clamped.
TEST_F(RefinementTest, TheLossIsThatOfALineWithTheLargestMisfit) {
  Look(0.3, 12);
  const std::vector<ResolvedObservation> observations = ViewsWithABadMask();
  const auto refine = [&](double loss_px, double max_misfit_px) {
    ObjectRefinementOptions options;
    options.loss_px = loss_px;
    options.max_misfit_px = max_misfit_px;
    return RefineEllipsoid(Start(), made_.ellipsoid, sensor_, observations, 4.0, options).ellipsoid;
  };
  const Ellipsoid ellipsoid = refine(8.0, 5.0);
  EXPECT_LT(AxisError(refine(16.0, 10.0), ellipsoid), 1e-9);
  EXPECT_GT(AxisError(refine(16.0, 5.0), ellipsoid), 1e-4);
}

TEST_F(RefinementTest, AnEllipsoidBehindAllCamerasDoesNotMove) {
  Look(0.05, 3);
  Ellipsoid behind = made_.ellipsoid;
  behind.world_from_object.translation = {5.0, 0.0, 0.5};
  const Refinement refined = RefineEllipsoid(behind, behind, sensor_, Observations(), 5.0, {});
  EXPECT_LT((refined.ellipsoid.world_from_object.translation - behind.world_from_object.translation)
                .norm(),
            1.0);
  EXPECT_TRUE(refined.ellipsoid.half_axes.allFinite());
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/validity.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "objects/constraint/misfit.h"
#include "objects/made_objects.h"

namespace hullslam {
namespace {

TEST(ObjectRejection, EveryReasonHasAName) {
  std::set<std::string> names;
  for (int i = 0; i < kObjectRejectionCount; ++i) {
    names.insert(ToString(static_cast<ObjectRejection>(i)));
  }
  EXPECT_EQ(names.size(), static_cast<size_t>(kObjectRejectionCount));
  EXPECT_EQ(ToString(ObjectRejection::kFewKeyframes), "few_views");
  EXPECT_EQ(ToString(ObjectRejection::kFused), "fused");
}

class Validity : public ::testing::Test {
 protected:
  Validity() {
    id_ = map_.AddObject();
    for (int i = 0; i < 5; ++i) {
      map_.AddObservation(
          id_, AddObserver(map_, sensor_, CameraOnCircle(0.1 * i, 1.5, 0.5), {made_}), 0);
    }
  }
  std::optional<ObjectRejection> Reason(const Ellipsoid& ellipsoid) const {
    const auto objection = FindObjection(
        ellipsoid, sensor_, ResolveObservations(map_, map_.objects().At(id_)), options_);
    return objection ? std::optional(objection->reason) : std::nullopt;
  }
  // Four observations from cameras 1.5 m away that are 1.5 cm apart. They belong to `map`.
  std::vector<ResolvedObservation> ViewsFromOneSide(Map& map, double height) const {
    const ObjectId id = map.AddObject();
    for (int i = 0; i < 4; ++i) {
      const Rigid3 camera = CameraOnCircle(0.01 * i, 1.5, height);
      map.AddObservation(id, AddObserver(map, sensor_, camera, {made_}), 0);
    }
    return ResolveObservations(map, map.objects().At(id));
  }
  Ellipsoid Scaled(double x, double y, double z) const {
    Ellipsoid ellipsoid = made_.ellipsoid;
    ellipsoid.half_axes = ellipsoid.half_axes.cwiseProduct(Eigen::Vector3d(x, y, z));
    return ellipsoid;
  }
  Sensor sensor_ = MakeObjectSensor();
  ValidityOptions options_;
  MadeObject made_ = MakeObject("cup", Eigen::Vector3d::Zero(), {0.10, 0.08, 0.12});
  Map map_;
  ObjectId id_;
};

TEST_F(Validity, TheTrueQuadricIsValid) {
  EXPECT_EQ(Reason(made_.ellipsoid), std::nullopt);
  const auto observations = ResolveObservations(map_, map_.objects().At(id_));
  EXPECT_NEAR(MeanOverlap(made_.ellipsoid, sensor_, observations), 1.0, 1e-9);
}

TEST_F(Validity, NotInFrontOfACamera) {
  Ellipsoid ellipsoid = made_.ellipsoid;
  ellipsoid.world_from_object.translation = {3.0, 0.0, 0.5};
  EXPECT_EQ(Reason(ellipsoid), ObjectRejection::kNotInFront);
  ellipsoid.world_from_object.translation.x() = std::nan("");
  EXPECT_EQ(Reason(ellipsoid), ObjectRejection::kNotInFront);
}

TEST_F(Validity, AxesOutOfRange) {
  EXPECT_EQ(Reason(Scaled(0.01, 1.0, 1.0)), ObjectRejection::kAxesOutOfRange);
}

// The cameras are 1.58 m away.
TEST_F(Validity, BothEndsOfTheRangeOfAxesAreSharesOfTheDistance) {
  options_.min_half_axis = 0.08 / 1.57;
  EXPECT_EQ(Reason(made_.ellipsoid), ObjectRejection::kAxesOutOfRange);
  options_.min_half_axis = 0.08 / 1.60;
  EXPECT_EQ(Reason(made_.ellipsoid), std::nullopt);
  options_.max_half_axis = 0.12 / 1.60;
  EXPECT_EQ(Reason(made_.ellipsoid), ObjectRejection::kAxesOutOfRange);
  options_.max_half_axis = 0.12 / 1.57;
  EXPECT_EQ(Reason(made_.ellipsoid), std::nullopt);
}

TEST_F(Validity, NearTheSurfaceIsTheLargerOfBothShares) {
  EXPECT_DOUBLE_EQ(NearSurface(made_.ellipsoid, 1.0, {}), 0.03);
  EXPECT_DOUBLE_EQ(NearSurface(made_.ellipsoid, 2.0, {}), 0.06);
  EXPECT_DOUBLE_EQ(NearSurface(made_.ellipsoid, 0.1, {}), 0.2 * 0.1);
}

// In a map of unknown scale, the validity does not change if everything is ten times larger.
TEST_F(Validity, DoesNotDependOnTheScaleOfTheMap) {
  std::vector<Detection> detections;
  std::vector<ResolvedObservation> observations = ResolveObservations(map_, map_.objects().At(id_));
  detections.reserve(observations.size());
  for (ResolvedObservation& observation : observations) {
    observation.cam_from_world.translation *= 10.0;
    Detection& seen = detections.emplace_back(*observation.detection);
    std::vector<Eigen::Vector3d> points = seen.points.Unpack();
    for (Eigen::Vector3d& point : points) {
      point *= 10.0;
    }
    seen.points = points;
    observation.detection = &seen;
  }
  for (const double size : {0.04, 0.5, 0.9, 1.0, 1.1, 2.0, 5.0}) {
    const Ellipsoid ellipsoid = Scaled(size, 1.0, 1.0);
    Ellipsoid larger = ellipsoid;
    larger.half_axes *= 10.0;
    const auto objection = FindObjection(larger, sensor_, observations, options_);
    EXPECT_EQ(objection ? std::optional(objection->reason) : std::nullopt, Reason(ellipsoid))
        << size;
  }
}

TEST_F(Validity, AnOutlineElsewhere) {
  Ellipsoid ellipsoid = made_.ellipsoid;
  ellipsoid.world_from_object.translation = {0.0, 0.0, 0.15};
  EXPECT_EQ(Reason(ellipsoid), ObjectRejection::kLowOverlap);
}

// A box has a larger area than the outline that touches its four sides, so the box of the outline
// is compared with it.
TEST_F(Validity, ABoxIsComparedWithTheBoxOfTheOutline) {
  std::vector<Detection> detections;
  std::vector<ResolvedObservation> observations = ResolveObservations(map_, map_.objects().At(id_));
  detections.reserve(observations.size());
  for (ResolvedObservation& observation : observations) {
    Detection& seen = detections.emplace_back(*observation.detection);
    seen.is_box = true;
    const Eigen::Vector2d& low = seen.box.min();
    const Eigen::Vector2d& high = seen.box.max();
    seen.hull = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    observation.detection = &seen;
  }
  EXPECT_NEAR(MeanOverlap(made_.ellipsoid, sensor_, observations), 1.0, 1e-9);
}

// The ellipsoid is farther away and larger, so the outlines still agree with it.
TEST_F(Validity, ADriftAlongTheViewThatOutlinesDoNotShow) {
  Map map;
  const auto observations = ViewsFromOneSide(map, 0.5);
  const Eigen::Vector3d camera = Inverse(observations[1].cam_from_world).translation;
  Ellipsoid drifted = made_.ellipsoid;
  drifted.world_from_object.translation = -0.35 * camera;
  drifted.half_axes *= 1.35;
  EXPECT_GT(MeanOverlap(drifted, sensor_, observations), 0.8);
  const auto objection = FindObjection(drifted, sensor_, observations, {});
  ASSERT_TRUE(objection);
  EXPECT_EQ(objection->reason, ObjectRejection::kOffPoints);
  EXPECT_NE(objection->detail.find("expected at least 0.40"), std::string::npos);
}

TEST_F(Validity, AnAxisAlongTheViewThatNothingConstrains) {
  const Ellipsoid stretched = Scaled(5.0, 1.0, 1.0);
  const auto reason = Reason(stretched);
  EXPECT_TRUE(reason == ObjectRejection::kStretched || reason == ObjectRejection::kLowOverlap);
}

// The cameras look along the x axis, so the outlines hardly show how long it is. The points extend
// to 0.1 m, the half axis of 0.5 m is nearly five times as long.
TEST_F(Validity, AHalfAxisMayExceedThePointsByTheFactorOfTheOptions) {
  Map map;
  const auto observations = ViewsFromOneSide(map, 0.0);
  const Ellipsoid stretched = Scaled(5.0, 1.0, 1.0);
  EXPECT_GT(MeanOverlap(stretched, sensor_, observations), 0.8);
  options_.max_elongation = 10.0;
  options_.max_stretch = 6.0;
  EXPECT_FALSE(FindObjection(stretched, sensor_, observations, options_));
  options_.max_stretch = 4.0;
  const auto objection = FindObjection(stretched, sensor_, observations, options_);
  ASSERT_TRUE(objection);
  EXPECT_EQ(objection->reason, ObjectRejection::kStretched);
}

TEST_F(Validity, ElongationIsAlongTheViewOverAcross) {
  const auto observations = ResolveObservations(map_, map_.objects().At(id_));
  Ellipsoid ball = made_.ellipsoid;
  ball.half_axes = Eigen::Vector3d::Constant(0.1);
  EXPECT_NEAR(Elongation(ball, observations), 1.0, 1e-9);
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (const ResolvedObservation& observation : observations) {
    direction -= Inverse(observation.cam_from_world).translation.normalized();
  }
  ball.world_from_object.rotation =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), direction);
  ball.half_axes = {0.3, 0.05, 0.2};  // the extent across the view is sqrt(0.05 * 0.2)
  EXPECT_NEAR(Elongation(ball, observations), 3.0, 1e-9);
  ball.half_axes = {0.01, 0.1, 0.1};
  EXPECT_NEAR(Elongation(ball, observations), 0.25 * 10.0, 1e-9);
}

// The cameras see the object from directions that are up to 22 degrees apart.
TEST_F(Validity, AnElongatedQuadricNeedsParallax) {
  const auto observations = ResolveObservations(map_, map_.objects().At(id_));
  const double elongation = Elongation(made_.ellipsoid, observations);
  const double parallax = Parallax(observations, Eigen::Vector3d::Zero());
  options_.max_elongation = elongation - 0.01;
  options_.elongation_parallax = parallax / elongation - 0.1;
  EXPECT_EQ(Reason(made_.ellipsoid), std::nullopt);
  options_.elongation_parallax = parallax / elongation + 0.1;
  EXPECT_EQ(Reason(made_.ellipsoid), ObjectRejection::kElongated);
  options_.max_elongation = elongation + 0.01;
  EXPECT_EQ(Reason(made_.ellipsoid), std::nullopt);
}

TEST_F(Validity, TheMisfitIsComparedWithTheSizeOfTheMasks) {
  options_.min_overlap = 0.0;
  const Ellipsoid larger = Scaled(1.2, 1.2, 1.2);
  const auto observations = ResolveObservations(map_, map_.objects().At(id_));
  const double misfit = RelativeMisfit(sensor_.camera, larger, observations);
  // 0.2 of a radius, whose square is 1 / pi of the area
  EXPECT_NEAR(misfit, 0.2 / std::sqrt(std::numbers::pi), 0.01);
  options_.max_misfit = misfit - 0.001;
  EXPECT_EQ(Reason(larger), ObjectRejection::kLargeMisfit);
  options_.max_misfit = misfit + 0.001;
  EXPECT_EQ(Reason(larger), std::nullopt);
}

}  // namespace

}  // namespace hullslam

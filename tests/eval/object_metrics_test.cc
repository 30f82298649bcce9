// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/object_metrics.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/polygon.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

const PinholeCamera kCamera{.fx = 200.0, .fy = 210.0, .cx = 320.0, .cy = 240.0};

// The outline of a cone of rays with this half angle about an axis.
std::vector<Eigen::Vector2d> Cone(const Eigen::Vector3d& axis, double half_angle) {
  constexpr int kCorners = 720;
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis);
  std::vector<Eigen::Vector2d> polygon;
  for (int i = 0; i < kCorners; ++i) {
    const double t = 2.0 * std::numbers::pi * i / kCorners;
    const Eigen::Vector3d ray(std::sin(half_angle) * std::cos(t),
                              std::sin(half_angle) * std::sin(t), std::cos(half_angle));
    polygon.push_back(kCamera.Project(turn * ray));
  }
  return polygon;
}

TEST(SolidAngle, IsThatOfAConeWhereverItIs) {
  for (const double angle : {0.0, 0.5, 1.0, 1.2}) {
    const Eigen::Vector3d axis(std::sin(angle), 0.0, std::cos(angle));
    EXPECT_NEAR(SolidAngle(kCamera, Cone(axis, 0.15)),
                2.0 * std::numbers::pi * (1.0 - std::cos(0.15)), 1e-5)
        << angle;
  }
  std::vector<Eigen::Vector2d> turned = Cone(Eigen::Vector3d::UnitZ(), 0.15);
  std::reverse(turned.begin(), turned.end());
  EXPECT_LT(SolidAngle(kCamera, turned), 0.0);
}

// Two overlapping cones have the same overlap in the middle of the image and at its rim, which the
// areas of their outlines do not have.
TEST(SolidAngle, TheOverlapDoesNotDependOnThePlaceInTheImage) {
  const auto cones = [](double angle, double other) {
    return std::array{Cone({std::sin(angle), 0.0, std::cos(angle)}, 0.15),
                      Cone({std::sin(other), 0.0, std::cos(other)}, 0.10)};
  };
  const auto middle = cones(0.0, 0.1);
  const auto rim = cones(1.1, 1.2);
  const double expected = OverlapOnSphere(kCamera, middle[0], middle[1]);
  EXPECT_GT(expected, 0.2);
  EXPECT_NEAR(OverlapOnSphere(kCamera, rim[0], rim[1]), expected, 1e-4);
  EXPECT_GT(std::abs(IntersectionOverUnion(rim[0], rim[1]) - expected), 0.02);
  EXPECT_NEAR(OverlapOnSphere(kCamera, rim[1], rim[0]), expected, 1e-4);
}

TEST(SolidAngle, EmptySetsDoNotOverlap) {
  const auto cone = Cone(Eigen::Vector3d::UnitZ(), 0.1);
  EXPECT_NEAR(OverlapOnSphere(kCamera, cone, cone), 1.0, 1e-12);
  EXPECT_EQ(OverlapOnSphere(kCamera, cone, {}), 0.0);
  EXPECT_EQ(OverlapOnSphere(kCamera, {}, cone), 0.0);
  EXPECT_EQ(OverlapOnSphere(kCamera, {}, {}), 0.0);
}

PinholeCamera Camera() {
  PinholeCamera camera;
  camera.fx = 500.0;
  camera.fy = 500.0;
  camera.cx = 320.0;
  camera.cy = 240.0;
  return camera;
}

Ellipsoid Sphere(double depth, double radius) {
  return {Rigid3(Eigen::Quaterniond::Identity(), {0.0, 0.0, depth}),
          Eigen::Vector3d::Constant(radius)};
}

// Lines at a distance of `gap` px outside the ellipse, in `count` directions.
std::vector<SilhouetteLine> LinesAround(const Ellipse& ellipse, int count, double gap) {
  std::vector<SilhouetteLine> lines;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    const double reach = ellipse.HalfExtent(normal) + gap;
    lines.push_back({{normal, -normal.dot(ellipse.center) - reach}, false});
  }
  return lines;
}

// The observation that a perfect segmenter has of the ellipsoid.
ObservationResult PerfectView(const Ellipsoid& ellipsoid, const Rigid3& cam_from_world = {}) {
  const Ellipse ellipse = ProjectEllipsoid(Camera().Matrix(), cam_from_world, ellipsoid).value();
  ObservationResult observation;
  observation.cam_from_world = cam_from_world;
  observation.hull = ellipse.Polygon(200);
  observation.contour = observation.hull;
  observation.lines = LinesAround(ellipse, 9, 0.0);
  return observation;
}

ObjectFit MeasureView(const Ellipsoid& ellipsoid, const ObservationResult& observation,
                      const PinholeCamera& camera) {
  return MeasureObject(ellipsoid, {&observation, 1}, camera);
}

TEST(ObjectMetrics, APerfectViewFitsPerfectly) {
  const Ellipsoid ellipsoid = {Rigid3(ExpSo3({0.3, 0.5, -0.2}), {0.1, -0.1, 2.0}), {0.1, 0.2, 0.3}};
  const ObjectFit fit = MeasureView(ellipsoid, PerfectView(ellipsoid), Camera());
  EXPECT_GT(fit.siou.value(), 0.999);
  EXPECT_GT(fit.siou_mask.value(), 0.999);
  EXPECT_LT(fit.mtd_m2.value(), 1e-12);
  EXPECT_LT(fit.tangent_px.value(), 1e-9);
  EXPECT_EQ(fit.observations, 1U);
  EXPECT_EQ(fit.lines, 9U);
}

TEST(ObjectMetrics, TangentDistanceIsPositiveOnBothSides) {
  const Ellipsoid sphere = Sphere(2.0, 0.3);
  const Ellipse ellipse = ProjectEllipsoid(Camera().Matrix(), {}, sphere).value();
  ObservationResult observation = PerfectView(sphere);
  observation.lines = LinesAround(ellipse, 4, 3.0);
  EXPECT_NEAR(MeasureView(sphere, observation, Camera()).tangent_px.value(), 3.0, 1e-9);
  observation.lines = LinesAround(ellipse, 4, -5.0);
  EXPECT_NEAR(MeasureView(sphere, observation, Camera()).tangent_px.value(), 5.0, 1e-9);
}

// A plane through the centre of a sphere of radius r has pi^T Q* pi = r^2. A plane at distance d
// from the centre has r^2 - d^2.
TEST(ObjectMetrics, MtdMatchesHandComputedValues) {
  const Ellipsoid sphere = Sphere(2.0, 0.3);
  ObservationResult observation = PerfectView(sphere);
  observation.lines = {{{Eigen::Vector2d::UnitX(), -320.0}, false}};  // x = cx: the plane x = 0
  EXPECT_NEAR(MeasureView(sphere, observation, Camera()).mtd_m2.value(), 0.09, 1e-12);
  // x = cx + fx: the plane x = z, sqrt(2) from the centre.
  observation.lines = {{{Eigen::Vector2d::UnitX(), -820.0}, false}};
  EXPECT_NEAR(MeasureView(sphere, observation, Camera()).mtd_m2.value(), 2.0 - 0.09, 1e-12);
}

TEST(ObjectMetrics, OneSidedLinesAreNotCounted) {
  const Ellipsoid sphere = Sphere(2.0, 0.3);
  ObservationResult observation = PerfectView(sphere);
  observation.lines.push_back({{Eigen::Vector2d::UnitX(), 1000.0}, true});
  EXPECT_LT(MeasureView(sphere, observation, Camera()).tangent_px.value(), 1e-9);
  EXPECT_EQ(MeasureView(sphere, observation, Camera()).lines, 9U);
  observation.lines = {observation.lines.back()};
  EXPECT_FALSE(MeasureView(sphere, observation, Camera()).tangent_px);
  EXPECT_FALSE(MeasureView(sphere, observation, Camera()).mtd_m2);
}

TEST(ObjectMetrics, IsInvariantUnderACommonMotionOfWorldAndCamera) {
  RandomGeometry random(3);
  const Ellipsoid ellipsoid = {random.Pose(1.0, 0.2), {0.1, 0.2, 0.3}};
  const Rigid3 cam_from_world(ExpSo3({0.1, 0.2, 0.3}), {0.0, 0.1, 2.0});
  ObservationResult observation = PerfectView(ellipsoid, cam_from_world);
  const Ellipsoid larger = {ellipsoid.world_from_object, 1.2 * ellipsoid.half_axes};
  const ObjectFit before = MeasureView(larger, observation, Camera());
  const Rigid3 motion = random.Pose(2.0, 5.0);
  observation.cam_from_world = cam_from_world * Inverse(motion);
  const ObjectFit after = MeasureView(motion * larger, observation, Camera());
  EXPECT_LT(before.siou.value(), 0.8);
  EXPECT_NEAR(after.siou.value(), before.siou.value(), 1e-9);
  EXPECT_NEAR(after.siou_mask.value(), before.siou_mask.value(), 1e-9);
  EXPECT_NEAR(after.mtd_m2.value(), before.mtd_m2.value(), 1e-9);
  EXPECT_NEAR(after.tangent_px.value(), before.tangent_px.value(), 1e-6);
}

TEST(ObjectMetrics, OnlyThePartInsideTheImageIsCompared) {
  Ellipsoid sphere = Sphere(2.0, 0.3);
  sphere.world_from_object.translation.x() = 1.28;  // at the right border, x = 640
  const ObservationResult whole = PerfectView(sphere);
  EXPECT_GT(MeasureView(sphere, whole, Camera()).siou.value(), 0.999);
  ObservationResult cut = whole;
  cut.hull = ClipToBox(whole.hull, {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(639.5, 479.5)});
  cut.contour = cut.hull;
  EXPECT_GT(MeasureView(sphere, cut, Camera()).siou.value(), 0.99);
  EXPECT_GT(MeasureView(sphere, cut, Camera()).siou_mask.value(), 0.99);
}

TEST(ObjectMetrics, AContourMayBeConcaveAndOfEitherOrientation) {
  const Ellipsoid all_over = Sphere(2.0, 1.9);  // its projected ellipse covers the whole image
  ObservationResult observation;
  observation.hull = {{100, 100}, {300, 100}, {300, 300}, {100, 300}};
  // The lower left quarter of the square is cut out.
  observation.contour = {{100, 100}, {300, 100}, {300, 300}, {200, 300}, {200, 200}, {100, 200}};
  const PinholeCamera::Bounds image = Camera().UndistortedBounds();
  const double pixels = (image.max_x - image.min_x) * (image.max_y - image.min_y);
  EXPECT_NEAR(MeasureView(all_over, observation, Camera()).siou.value(), 40000.0 / pixels, 1e-6);
  EXPECT_NEAR(MeasureView(all_over, observation, Camera()).siou_mask.value(), 30000.0 / pixels,
              1e-6);
  std::reverse(observation.contour.begin(), observation.contour.end());
  EXPECT_NEAR(MeasureView(all_over, observation, Camera()).siou_mask.value(), 30000.0 / pixels,
              1e-6);
}

TEST(ObjectMetrics, ABoxIsComparedWithTheBoxOfTheEllipse) {
  const Ellipsoid sphere = Sphere(2.0, 0.3);
  ObservationResult observation = PerfectView(sphere);
  const Eigen::AlignedBox2d box = ProjectEllipsoid(Camera().Matrix(), {}, sphere).value().Bounds();
  observation.hull = {
      box.min(), {box.max().x(), box.min().y()}, box.max(), {box.min().x(), box.max().y()}};
  observation.contour = observation.hull;
  EXPECT_NEAR(MeasureView(sphere, observation, Camera()).siou.value(), std::numbers::pi / 4.0,
              0.01);
  observation.is_box = true;
  EXPECT_GT(MeasureView(sphere, observation, Camera()).siou.value(), 0.99);
  EXPECT_FALSE(MeasureView(sphere, observation, Camera()).siou_mask);
}

TEST(ObjectMetrics, AnEllipsoidNotInFrontHasNoOverlapAndNoDistance) {
  const ObservationResult observation = PerfectView(Sphere(2.0, 0.3));
  for (const double depth : {-2.0, 0.1}) {
    const ObjectFit fit = MeasureView(Sphere(depth, 0.3), observation, Camera());
    EXPECT_EQ(fit.siou.value(), 0.0);
    EXPECT_EQ(fit.siou_mask.value(), 0.0);
    EXPECT_FALSE(fit.mtd_m2);
    EXPECT_FALSE(fit.tangent_px);
  }
}

TEST(ObjectMetrics, MeansAreOverViewsAndThenOverMappedObjects) {
  const Ellipsoid sphere = Sphere(2.0, 0.3);
  const ObservationResult good = PerfectView(sphere);
  ObservationResult missed = good;
  missed.hull = {{0, 0}, {20, 0}, {20, 20}};
  missed.lines.clear();
  ObjectResults report;
  report.camera = Camera();
  report.objects.resize(3);
  for (ObjectResult& object : report.objects) {
    object.state = ObjectState::kMapped;
    object.ellipsoid = sphere;
  }
  report.objects[0].observations = {good, missed};      // mean 1/2
  report.objects[1].observations = {good, good, good};  // 1
  report.objects[2].state = ObjectState::kCandidate;
  report.objects[2].observations = {missed};
  MeasureObjects(report);
  EXPECT_NEAR(report.objects[0].fit.siou.value(), 0.5, 1e-3);
  EXPECT_EQ(report.objects[0].fit.lines, 9U);
  EXPECT_LT(report.objects[0].fit.tangent_px.value(), 1e-9);
  const MapFit summary = SummarizeFits(report);
  EXPECT_EQ(summary.objects, 2U);
  EXPECT_EQ(summary.mean.observations, 5U);
  EXPECT_EQ(summary.mean.lines, 36U);
  EXPECT_NEAR(summary.mean.siou.value(), 0.75, 1e-3);
}

TEST(ObjectMetrics, AnEmptyReportHasNoMeans) {
  const MapFit summary = SummarizeFits(ObjectResults());
  EXPECT_EQ(summary.objects, 0U);
  EXPECT_FALSE(summary.mean.siou);
  EXPECT_FALSE(MeasureObject(Sphere(2.0, 0.3), {}, Camera()).tangent_px);
}

}  // namespace

}  // namespace hullslam

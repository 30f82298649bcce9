// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/object_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/polygon.h"
#include "scene/made_scene.h"

namespace hullslam {
namespace {

TEST(SphereDirection, EachHasItsShareOfTheSphere) {
  constexpr int kCount = 256;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d direction = SphereDirection(i, kCount);
    EXPECT_NEAR(direction.norm(), 1.0, 1e-12);
    EXPECT_EQ(direction.z() > 0.0, i < kCount / 2);
    spread += 3.0 / kCount * direction * direction.transpose();
    double nearest = -1.0;
    for (int k = 0; k < kCount; ++k) {
      nearest = k == i ? nearest : std::max(nearest, direction.dot(SphereDirection(k, kCount)));
    }
    // A direction's share of the sphere is a disc of 7.2 degrees; neighbours are 9 to 16 apart.
    EXPECT_LT(nearest, std::cos(0.15)) << i;
    EXPECT_GT(nearest, std::cos(0.28)) << i;
  }
  EXPECT_TRUE(spread.isApprox(Eigen::Matrix3d::Identity(), 0.01)) << spread;
}

const Eigen::Quaterniond kUpright = Eigen::Quaterniond::Identity();

ObjectBody BodyOf(const MadeObject& object) {
  return BodyOfEllipsoid(ObjectId(1), object.ellipsoid, kUpright);
}

TEST(ObjectBody, OfAnEllipsoidHasItsExtents) {
  const ObjectBody body = BodyOf(Standing("cup", {1.0, 2.0, 0.5}, {0.2, 0.1, 0.3}));
  EXPECT_NEAR(body.bottom, 0.5, 1e-9);
  EXPECT_NEAR(body.top, 1.1, 1e-9);
  EXPECT_NEAR(body.size, (0.4 + 0.2 + 0.6) / 3.0, 1e-9);
  EXPECT_NEAR(body.width, 0.3, 1e-9);
  const UprightBox box = BoxOf(body, kUpright);
  EXPECT_LT((box.world_from_box.translation - Eigen::Vector3d(1.0, 2.0, 0.8)).norm(), 1e-9);
}

TEST(ObjectBody, BoxIsUprightInATurnedWorld) {
  const Eigen::Vector3d up = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  const Eigen::Quaterniond upright = UprightFromWorld(up);
  const MadeObject made = Standing("cup", {1.0, 2.0, 0.5}, {0.2, 0.1, 0.3});
  const Ellipsoid in_world = Rigid3(upright.conjugate(), Eigen::Vector3d::Zero()) * made.ellipsoid;
  const UprightBox box = BoxOf(BodyOfEllipsoid(ObjectId(1), in_world, upright), upright);
  EXPECT_LT((box.world_from_box.rotation * Eigen::Vector3d::UnitZ() - up).norm(), 1e-9);
  EXPECT_NEAR(box.half_extents.z(), 0.3, 1e-9);
  EXPECT_LT((box.world_from_box.translation - in_world.world_from_object.translation).norm(), 1e-9);
}

// The mask of a box whose ellipsoid only touches its faces.
TEST(ObjectBody, OfABoxHasTheExtentsOfTheBoxAndNotOfTheEllipsoid) {
  const Sensor sensor = MakeObjectSensor();
  const Eigen::Vector3d half(0.2, 0.1, 0.15);
  const MadeObject fitted = {"box", {Rigid3(), 1.25 * half}};
  std::vector<Detection> detections;
  std::vector<ResolvedObservation> observations;
  detections.reserve(24);
  for (uint32_t i = 0; i < 24; ++i) {
    const Rigid3 camera = CameraOnCircle(0.26 * i, 2.5, i % 2 == 0 ? 1.2 : 0.1);
    std::vector<Eigen::Vector2d> corners;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d signs(corner % 2 * 2 - 1, corner / 2 % 2 * 2 - 1, corner / 4 * 2 - 1);
      corners.push_back(sensor.camera.Project(camera * half.cwiseProduct(signs).eval()));
    }
    Detection& detection = detections.emplace_back(Detect(fitted, sensor, camera));
    for (SilhouetteLine& line : detection.lines) {
      double reach = -1e9;
      for (const Eigen::Vector2d& corner : corners) {
        reach = std::max(reach, line.line.normal.dot(corner));
      }
      line.line.offset = -reach;
    }
    observations.push_back({KeyframeId(i), camera, &detection});
  }
  const ObjectBody body =
      MeasureBody(ObjectId(1), fitted.ellipsoid, sensor.camera, observations, kUpright);
  const UprightBox box = BoxOf(body, kUpright);
  EXPECT_NEAR(box.half_extents.head<2>().maxCoeff(), half.x(), 0.015);
  EXPECT_NEAR(box.half_extents.head<2>().minCoeff(), half.y(), 0.015);
  EXPECT_TRUE(body.is_bottom_seen);
}

// As of a plant whose pot is behind a couch: its leaves end freely to both sides of the couch.
TEST(ObjectBody, LinesThatPointMoreSidewaysThanDownDoNotShowTheBottom) {
  const Sensor sensor = MakeObjectSensor();
  const MadeObject made = Standing("plant", {0.0, 0.0, 0.0}, {0.2, 0.2, 0.3});
  std::vector<Detection> detections;
  std::vector<ResolvedObservation> observations;
  detections.reserve(2);
  for (uint32_t i = 0; i < 2; ++i) {
    const Rigid3 camera = CameraOnCircle(0.3 + i, 2.5, 0.8);
    Detection& detection = detections.emplace_back(Detect(made, sensor, camera));
    for (SilhouetteLine& line : detection.lines) {
      line.is_one_sided = line.line.normal.y() > 0.8;  // those at 45 degrees are free
    }
    observations.push_back({KeyframeId(i), camera, &detection});
  }
  EXPECT_FALSE(MeasureBody(ObjectId(1), made.ellipsoid, sensor.camera, observations, kUpright)
                   .is_bottom_seen);
}

TEST(ObjectBody, BottomIsNotSeenIfItIsAlwaysCutOff) {
  const Sensor sensor = MakeObjectSensor();
  const MadeObject made = Standing("couch", {0.0, 0.0, 0.0}, {0.2, 0.1, 0.3});
  const Rigid3 camera = CameraOnCircle(0.3, 2.5, 0.6);
  Detection detection = Detect(made, sensor, camera);
  for (SilhouetteLine& line : detection.lines) {
    line.is_one_sided = line.line.normal.y() > 0.0;  // the lower side
  }
  const std::vector<ResolvedObservation> observations = {{KeyframeId(0), camera, &detection}};
  EXPECT_FALSE(MeasureBody(ObjectId(1), made.ellipsoid, sensor.camera, observations, kUpright)
                   .is_bottom_seen);
}

TEST(ObjectBody, GapAndOverlapOfFootprints) {
  const ObjectBody a = BodyOf(Standing("cup", {0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}));
  const ObjectBody far = BodyOf(Standing("cup", {1.0, 0.0, 3.0}, {0.2, 0.3, 0.1}));
  EXPECT_NEAR(FootprintGap(a, far), 0.7, 1e-3);
  EXPECT_NEAR(FootprintGap(far, a), 0.7, 1e-3);
  EXPECT_EQ(FootprintOverlap(a, far), 0.0);
  const ObjectBody over = BodyOf(Standing("book", {0.05, 0.0, 0.0}, {0.5, 0.5, 0.1}));
  EXPECT_LT(FootprintGap(a, over), -0.5);
  EXPECT_NEAR(FootprintOverlap(a, over), 1.0, 1e-6);
  EXPECT_NEAR(FootprintOverlap(over, a), 1.0, 1e-6) << "a share of the smaller one";
}

TEST(EllipsoidGap, IsTheDistanceOfSpheres) {
  const MadeObject a = Standing("ball", {0.0, 0.0, 0.0}, {0.1, 0.1, 0.1});
  const MadeObject b = Standing("ball", {0.3, 0.4, 0.0}, {0.2, 0.2, 0.2});
  const double distance = std::sqrt(0.3 * 0.3 + 0.4 * 0.4 + 0.1 * 0.1);
  EXPECT_NEAR(EllipsoidGap(a.ellipsoid, b.ellipsoid), distance - 0.3, 1e-9);
}

TEST(VolumeShare, IsTheShareThatIsInside) {
  const Ellipsoid small = Standing("ball", {0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}).ellipsoid;
  const Ellipsoid large = Standing("bowl", {0.0, 0.0, -0.2}, {0.5, 0.5, 0.5}).ellipsoid;
  EXPECT_EQ(VolumeShare(small, large), 1.0);
  EXPECT_NEAR(VolumeShare(large, small), 0.008, 0.01);
  const Ellipsoid away = Standing("ball", {2.0, 0.0, 0.0}, {0.1, 0.1, 0.1}).ellipsoid;
  EXPECT_EQ(VolumeShare(small, away), 0.0);
}

TEST(ObjectBody, TheBoxIsTheOneOfLeastArea) {
  for (const double degrees : {30.0, 75.0, -30.0}) {
    const Eigen::Quaterniond turn = ExpSo3({0.0, 0.0, degrees * std::numbers::pi / 180.0});
    const Eigen::Vector3d center(1.0, 2.0, 0.8);
    const Ellipsoid ellipsoid = {Rigid3(turn, center), {0.2, 0.1, 0.3}};
    const UprightBox box = BoxOf(BodyOfEllipsoid(ObjectId(1), ellipsoid, kUpright), kUpright);
    EXPECT_LT((box.world_from_box.translation - center).norm(), 1e-9) << degrees;
    // The long side of the box is along the long axis of the ellipsoid.
    const Eigen::Vector3d in_box =
        box.world_from_box.rotation.conjugate() * (turn * Eigen::Vector3d::UnitX());
    EXPECT_NEAR(in_box.cwiseAbs().dot(box.half_extents), 0.2, 1e-9) << degrees;
    EXPECT_NEAR(box.half_extents.head<2>().sum(), 0.3, 1e-9) << degrees;
  }
}

// Whether the lower side was seen if an observation has so many lower lines that are cut off and
// free.
bool IsBottomSeen(int cut, int free) {
  const Sensor sensor = MakeObjectSensor();
  const MadeObject made = Standing("couch", {0.0, 0.0, 0.0}, {0.2, 0.1, 0.3});
  const Rigid3 camera = CameraOnCircle(0.3, 2.5, 0.3);
  const auto ellipse = ProjectEllipsoid(sensor.camera.Matrix(), camera, made.ellipsoid);
  Detection detection;
  for (int i = 0; i < cut + free; ++i) {
    const double angle = 0.02 * i;
    const Eigen::Vector2d normal(std::sin(angle), std::cos(angle));  // downwards in the image
    const double offset = -normal.dot(ellipse->center) - ellipse->HalfExtent(normal);
    detection.lines.push_back({{normal, offset}, i < cut});
  }
  const std::vector<ResolvedObservation> observations = {{KeyframeId(0), camera, &detection}};
  return MeasureBody(ObjectId(1), made.ellipsoid, sensor.camera, observations, kUpright)
      .is_bottom_seen;
}

TEST(ObjectBody, AQuarterOfTheLowerLinesAndAtLeastThreeShowTheBottom) {
  EXPECT_TRUE(IsBottomSeen(0, 3));
  EXPECT_FALSE(IsBottomSeen(0, 2));
  EXPECT_TRUE(IsBottomSeen(9, 3));
  EXPECT_FALSE(IsBottomSeen(10, 3));
}

}  // namespace

}  // namespace hullslam

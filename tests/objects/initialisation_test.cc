// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/initialisation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "objects/made_objects.h"
#include "support/random_geometry.h"
#include "support/test_cameras.h"

namespace hullslam {
namespace {

std::vector<Eigen::Vector3d> BoxPoints(const Rigid3& world_from_box, const Eigen::Vector3d& half,
                                       int count, uint32_t seed) {
  RandomGeometry random(seed);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(world_from_box * half.cwiseProduct(random.Vector(1.0)).eval());
  }
  return points;
}

Eigen::Vector3d Sorted(Eigen::Vector3d axes) {
  std::sort(axes.begin(), axes.end());
  return axes;
}

TEST(StartsFromPoints, AreTheBoxOfThePointsInflated) {
  const Rigid3 world_from_box(ExpSo3(Eigen::Vector3d(0.4, -0.3, 0.9)),
                              Eigen::Vector3d(0.5, 0.2, 1.0));
  const Eigen::Vector3d half(0.05, 0.12, 0.25);
  const auto starts = StartsFromPoints(BoxPoints(world_from_box, half, 3000, 1), 1.0, {});
  ASSERT_EQ(starts.size(), 2u);
  for (const Ellipsoid& start : starts) {
    EXPECT_LT((start.world_from_object.translation - world_from_box.translation).norm(), 0.01);
    // From the 3rd to the 97th percentile of an even distribution is 94 % of it.
    EXPECT_LT(
        (Sorted(start.half_axes) - 1.2 * 0.94 * half).cwiseQuotient(half).cwiseAbs().maxCoeff(),
        0.1);
    EXPECT_NEAR(start.world_from_object.rotation.norm(), 1.0, 1e-12);
  }
}

TEST(StartsFromPoints, OutliersDoNotStretchThem) {
  auto points = BoxPoints(Rigid3(), {0.1, 0.1, 0.1}, 1000, 2);
  for (int i = 0; i < 20; ++i) {
    points.emplace_back(0.0, 0.0, 3.0 + 0.01 * i);
  }
  for (const Ellipsoid& start : StartsFromPoints(points, 1.0, {.inflation = 1.0})) {
    EXPECT_LT(start.half_axes.maxCoeff(), 0.16);
  }
}

TEST(StartsFromPoints, FlatThingsHaveSomeThickness) {
  auto points = BoxPoints(Rigid3(), {0.2, 0.1, 0.0}, 500, 3);
  for (const Ellipsoid& start : StartsFromPoints(points, 2.0, {.min_half_axis = 0.01})) {
    EXPECT_EQ(start.half_axes.minCoeff(), 0.02);
    EXPECT_TRUE(start.world_from_object.rotation.coeffs().allFinite());
  }
}

TEST(StartsFromPoints, NeedPoints) {
  EXPECT_TRUE(StartsFromPoints(BoxPoints(Rigid3(), {0.2, 0.1, 0.1}, 19, 3), 1.0, {}).empty());
}

TEST(StartsFromPoints, AreReproducible) {
  const auto points = BoxPoints(Rigid3(), {0.2, 0.1, 0.1}, 300, 4);
  const auto a = StartsFromPoints(points, 1.0, {});
  const auto b = StartsFromPoints(points, 1.0, {});
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].half_axes, b[i].half_axes);
    EXPECT_EQ(a[i].world_from_object.rotation.coeffs(), b[i].world_from_object.rotation.coeffs());
  }
}

class Rays : public ::testing::Test {
 protected:
  std::optional<Ellipsoid> Start(double step) {
    Map map;
    const ObjectId object = map.AddObject();
    for (int i = 0; i < 4; ++i) {
      const KeyframeId keyframe =
          AddObserver(map, sensor_, CameraOnCircle(step * i, 1.5, 0.5), {made_});
      map.AddObservation(object, keyframe, 0);
    }
    return StartFromRays(sensor_.camera, ResolveObservations(map, map.objects().At(object)), {});
  }
  Sensor sensor_ = MakeObjectSensor();
  MadeObject made_ = MakeObject("ball", {0.1, 0.05, 0.02}, {0.1, 0.1, 0.1});
};

TEST_F(Rays, MeetAtTheCentreOfASphere) {
  const auto sphere = Start(0.3);
  ASSERT_TRUE(sphere);
  EXPECT_LT((sphere->world_from_object.translation - made_.ellipsoid.world_from_object.translation)
                .norm(),
            0.01);
  EXPECT_NEAR(sphere->half_axes.x(), 0.1, 0.01);
}

class RaysThrough : public ::testing::TestWithParam<TestCamera> {};

HULLSLAM_WITH_ALL_CAMERAS(RaysThrough);

// Near the side of a fisheye's image, the undistorted image of a ball is much larger than in the
// middle.
TEST_P(RaysThrough, ABallNearTheSideOfTheImageHasItsSize) {
  constexpr double kRadius = 0.06;  // m
  const Sensor& sensor = GetParam().sensor;
  const PinholeCamera& camera = sensor.camera;
  const Eigen::Vector2d pixel = camera.Undistort({0.9 * camera.width, 0.6 * camera.height});
  const MadeObject ball = MakeObject("ball", 2.5 * camera.Unproject(pixel, 1.0).normalized(),
                                     Eigen::Vector3d::Constant(kRadius));
  std::vector<Detection> detections;
  std::vector<Rigid3> poses;
  for (const Eigen::Vector3d& position :
       {Eigen::Vector3d(0.0, 0.0, 0.0), {0.0, 0.5, 0.0}, {0.0, -0.3, -0.3}}) {
    poses.emplace_back(Eigen::Quaterniond::Identity(), -position);
    detections.push_back(Detect(ball, sensor, poses.back()));
  }
  std::vector<ResolvedObservation> observations;
  for (size_t i = 0; i < poses.size(); ++i) {
    observations.push_back({KeyframeId(), poses[i], &detections[i]});
  }
  const auto sphere = StartFromRays(camera, observations, {});
  ASSERT_TRUE(sphere);
  EXPECT_LT(
      (sphere->world_from_object.translation - ball.ellipsoid.world_from_object.translation).norm(),
      0.02);
  EXPECT_NEAR(sphere->half_axes.x(), kRadius, 0.1 * kRadius);
}

TEST_F(Rays, ThatAreParallelGiveNothing) { EXPECT_FALSE(Start(0.0)); }

// The least angle between two rays is about 3.6 degrees.
TEST_F(Rays, NeedAnAngle) {
  made_ = MakeObject("ball", Eigen::Vector3d::Zero(), {0.1, 0.1, 0.1});
  const auto start = [&](double degrees) {
    Map map;
    const ObjectId object = map.AddObject();
    for (const double angle : {0.0, degrees * std::numbers::pi / 180.0}) {
      map.AddObservation(object,
                         AddObserver(map, sensor_, CameraOnCircle(angle, 1.5, 0.0), {made_}), 0);
    }
    return StartFromRays(sensor_.camera, ResolveObservations(map, map.objects().At(object)), {});
  };
  EXPECT_FALSE(start(3.4));
  EXPECT_TRUE(start(3.8));
}

// One camera sees the object at its left, the other one, to the right of it, at its right.
TEST_F(Rays, ThatMeetBehindTheCamerasGiveNothing) {
  std::vector<Detection> detections(2);
  std::vector<ResolvedObservation> observations;
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? -1.0 : 1.0;
    const Eigen::Vector2d center(sensor_.camera.cx + 100.0 * side, sensor_.camera.cy);
    detections[i].box = {center.array() - 20.0, center.array() + 20.0};
    observations.push_back(
        {KeyframeId(), {Eigen::Quaterniond::Identity(), {-0.2 * side, 0.0, 0.0}}, &detections[i]});
  }
  EXPECT_FALSE(StartFromRays(sensor_.camera, observations, {}));
  std::swap(observations[0].detection, observations[1].detection);
  EXPECT_TRUE(StartFromRays(sensor_.camera, observations, {}));
}

// Four observations within a few degrees of one another, too few for rays.
class Landmarks : public ::testing::Test {
 protected:
  std::vector<ResolvedObservation> Observations(double step) {
    const ObjectId object = map_.AddObject();
    for (int i = 0; i < 4; ++i) {
      const Rigid3 pose = CameraOnCircle(step * i, 1.5, 0.5);
      map_.AddObservation(object, textured_.AddObserver(map_, sensor_, pose), 0);
    }
    std::vector<ResolvedObservation> observations =
        ResolveObservations(map_, map_.objects().At(object));
    AddSurfaceLandmarks(map_, observations);
    return observations;
  }
  Sensor sensor_ = MakeObjectSensor();
  MadeObject made_ = MakeObject("ball", {0.1, 0.05, 0.02}, {0.1, 0.1, 0.1});
  TexturedObject textured_{made_, CameraOnCircle(0.0, 1.5, 0.5), 30};
  Map map_;
};

TEST_F(Landmarks, GiveASphereWithItsSurfaceAtTheirDepth) {
  const auto sphere = StartFromLandmarks(sensor_.camera, Observations(0.02), {});
  ASSERT_TRUE(sphere);
  EXPECT_LT((sphere->world_from_object.translation - made_.ellipsoid.world_from_object.translation)
                .norm(),
            0.02);
  EXPECT_NEAR(sphere->half_axes.x(), 0.1, 0.01);
}

TEST_F(Landmarks, BehindTheObjectDoNotMoveItIfTheyAreFew) {
  std::vector<ResolvedObservation> observations = Observations(0.02);
  for (ResolvedObservation& observation : observations) {
    for (size_t i = 0; i < 10; ++i) {
      observation.landmarks[3 * i] *= 3.0;
    }
  }
  const auto sphere = StartFromLandmarks(sensor_.camera, observations, {});
  ASSERT_TRUE(sphere);
  EXPECT_LT((sphere->world_from_object.translation - made_.ellipsoid.world_from_object.translation)
                .norm(),
            0.04);
}

TEST_F(Landmarks, MustBeInHalfOfTheViews) {
  std::vector<ResolvedObservation> observations = Observations(0.02);
  observations[0].landmarks.clear();
  observations[2].landmarks.resize(2);
  EXPECT_TRUE(StartFromLandmarks(sensor_.camera, observations, {}));
  observations[3].landmarks.clear();
  EXPECT_FALSE(StartFromLandmarks(sensor_.camera, observations, {}));
  EXPECT_FALSE(StartFromLandmarks(sensor_.camera, {}, {}));
}

}  // namespace
}  // namespace hullslam

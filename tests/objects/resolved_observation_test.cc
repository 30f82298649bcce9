// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/resolved_observation.h"

#include <gtest/gtest.h>

#include <numbers>

#include "hullslam/util/check.h"
#include "objects/made_objects.h"

namespace hullslam {
namespace {

class ObjectViews : public ::testing::Test {
 protected:
  ObjectViews() {
    object_ = map_.AddObject();
    for (int i = 0; i < 7; ++i) {
      const KeyframeId keyframe =
          AddObserver(map_, sensor_, CameraOnCircle(0.1 * i, 1.5, 0.5), {made_});
      map_.AddObservation(object_, keyframe, 0);
    }
  }
  const ObjectLandmark& object() const { return map_.objects().At(object_); }

  Sensor sensor_ = MakeObjectSensor();
  MadeObject made_ = MakeObject("cup", {0.0, 0.0, 0.0}, {0.05, 0.06, 0.08});
  Map map_;
  ObjectId object_;
};

TEST_F(ObjectViews, AreThoseOfAllKeyframesOrEvenlyChosen) {
  EXPECT_EQ(ResolveObservations(map_, object()).size(), 7u);
  const auto some = ResolveObservations(map_, object(), 3);
  ASSERT_EQ(some.size(), 3u);
  EXPECT_EQ(some[0].keyframe, KeyframeId(0));
  EXPECT_EQ(some[1].keyframe, KeyframeId(3));
  EXPECT_EQ(some[2].keyframe, KeyframeId(6));
  EXPECT_EQ(ResolveObservations(map_, object(), 1).front().keyframe, KeyframeId(6));
}

TEST_F(ObjectViews, TheLatestAreThoseOfTheLastKeyframes) {
  const auto latest = LatestObservations(map_, object(), 2);
  ASSERT_EQ(latest.size(), 2u);
  EXPECT_EQ(latest[0].keyframe, KeyframeId(5));
  EXPECT_EQ(latest[1].keyframe, KeyframeId(6));
  EXPECT_EQ(latest[1].detection, ResolveObservations(map_, object()).back().detection);
  EXPECT_EQ(LatestObservations(map_, object(), 100).size(), 7u);
  EXPECT_TRUE(LatestObservations(map_, object(), 0).empty());
}

TEST_F(ObjectViews, PointsAreInTheWorld) {
  const auto points = CollectPoints(ResolveObservations(map_, object()), 100);
  EXPECT_GT(points.size(), 80u);
  EXPECT_LT(points.size(), 200u);
  for (const Eigen::Vector3d& point : points) {
    EXPECT_NEAR(made_.ellipsoid.RadialDistance(point), 0.0, 1e-4);
  }
}

TEST_F(ObjectViews, TheCentroidLiesOnTheCamerasSide) {
  const ResolvedObservation observation = ResolveObservations(map_, object()).front();
  const Eigen::Vector3d camera = Inverse(observation.cam_from_world).translation;
  EXPECT_GT(Centroid(observation).dot(camera.normalized()), 0.01);
  const Detection empty;
  EXPECT_THROW(Centroid({KeyframeId(), Rigid3(), &empty}), CheckError);
}

TEST_F(ObjectViews, ParallaxIsTheLargestAngle) {
  const auto observations = ResolveObservations(map_, object());
  const Eigen::Vector3d a = Inverse(observations.front().cam_from_world).translation;
  const Eigen::Vector3d b = Inverse(observations.back().cam_from_world).translation;
  const double angle = std::acos(a.normalized().dot(b.normalized())) * 180.0 / std::numbers::pi;
  EXPECT_NEAR(Parallax(observations, Eigen::Vector3d::Zero()), angle, 1e-6);
  EXPECT_NEAR(Parallax(std::span(observations).first(1), Eigen::Vector3d::Zero()), 0.0, 1e-6);
}

class LandmarkViews : public ::testing::Test {
 protected:
  // Two observations, `degrees` apart.
  std::vector<ResolvedObservation> Observations(double degrees) {
    map_ = Map();
    const ObjectId object = map_.AddObject();
    for (const double angle : {0.0, degrees * std::numbers::pi / 180.0}) {
      const Rigid3 pose = CameraOnCircle(angle, 1.5, 0.0);
      map_.AddObservation(object, textured_.AddObserver(map_, sensor_, pose), 0);
    }
    std::vector<ResolvedObservation> observations =
        ResolveObservations(map_, map_.objects().At(object));
    AddSurfaceLandmarks(map_, observations);
    return observations;
  }
  Sensor sensor_ = MakeObjectSensor();
  TexturedObject textured_{MakeObject("cup", {0.0, 0.0, 0.0}, {0.05, 0.06, 0.08}),
                           CameraOnCircle(0.0, 1.5, 0.0), 7};
  Map map_;
};

TEST_F(LandmarkViews, HaveTheLandmarksInTheCamera) {
  for (const ResolvedObservation& observation : Observations(3.0)) {
    ASSERT_EQ(observation.landmarks.size(), 7u);
    for (size_t i = 0; i < 7; ++i) {
      EXPECT_LT(
          (observation.landmarks[i] - observation.cam_from_world * textured_.points()[i]).norm(),
          1e-9);
    }
    EXPECT_EQ(SurfacePoints(observation).size(), 7u);
    // The depth is between that of the nearest point of the surface and that of the centre.
    const double depth = LandmarkDepth(observation).value();
    EXPECT_GT(depth, 1.5 - 0.08);
    EXPECT_LT(depth, 1.5);
  }
}

TEST_F(LandmarkViews, LeaveOutLandmarksWithLittleParallax) {
  for (const ResolvedObservation& observation : Observations(1.0)) {
    EXPECT_TRUE(observation.landmarks.empty());
    EXPECT_FALSE(LandmarkDepth(observation));
  }
}

TEST_F(LandmarkViews, HaveNoLandmarksBeforeAddSurfaceLandmarks) {
  Observations(3.0);
  EXPECT_TRUE(ResolveObservations(map_, map_.objects().At(ObjectId(0))).front().landmarks.empty());
}

TEST_F(LandmarkViews, DepthPointsTakePrecedence) {
  ResolvedObservation observation = Observations(3.0).front();
  Detection detection = *observation.detection;
  detection.points = std::vector<Eigen::Vector3d>(1, {0.0, 0.0, 1.0});
  observation.detection = &detection;
  EXPECT_EQ(SurfacePoints(observation), std::vector<Eigen::Vector3d>(1, {0.0, 0.0, 1.0}));
}

TEST(LandmarkDepth, IsTheMedianOfThreeOrMore) {
  const Detection detection;
  ResolvedObservation observation{KeyframeId(0), Rigid3(), &detection};
  observation.landmarks = {{0.0, 0.0, 1.0}, {0.0, 0.0, 9.0}};
  EXPECT_FALSE(LandmarkDepth(observation));
  observation.landmarks.emplace_back(0.0, 0.0, 2.0);
  EXPECT_EQ(LandmarkDepth(observation), 2.0);
}

TEST(HasDepth, NeedsEnoughPointsInAllViewsTogether) {
  Detection detection;
  detection.points = std::vector<Eigen::Vector3d>(kMinDepthPoints / 2);
  const ResolvedObservation observation{KeyframeId(0), Rigid3(), &detection};
  EXPECT_FALSE(HasDepth(std::vector{observation}));
  EXPECT_TRUE(HasDepth(std::vector{observation, observation}));
}

TEST(MeanDistance, IsThatFromTheCameras) {
  const Detection detection;
  const std::vector<ResolvedObservation> observations = {
      {KeyframeId(0), Rigid3(), &detection},
      {KeyframeId(1), Rigid3(Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.0}), &detection}};
  EXPECT_DOUBLE_EQ(MeanDistance(observations, {0.0, 0.0, 3.0}), 4.0);
}

}  // namespace
}  // namespace hullslam

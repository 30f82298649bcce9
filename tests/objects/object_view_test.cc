// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/object_view.h"

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
  EXPECT_EQ(CollectViews(map_, object()).size(), 7u);
  const auto some = CollectViews(map_, object(), 3);
  ASSERT_EQ(some.size(), 3u);
  EXPECT_EQ(some[0].keyframe, KeyframeId(0));
  EXPECT_EQ(some[1].keyframe, KeyframeId(3));
  EXPECT_EQ(some[2].keyframe, KeyframeId(6));
  EXPECT_EQ(CollectViews(map_, object(), 1).front().keyframe, KeyframeId(6));
}

TEST_F(ObjectViews, TheLatestAreThoseOfTheLastKeyframes) {
  const auto latest = LatestViews(map_, object(), 2);
  ASSERT_EQ(latest.size(), 2u);
  EXPECT_EQ(latest[0].keyframe, KeyframeId(5));
  EXPECT_EQ(latest[1].keyframe, KeyframeId(6));
  EXPECT_EQ(latest[1].detection, CollectViews(map_, object()).back().detection);
  EXPECT_EQ(LatestViews(map_, object(), 100).size(), 7u);
  EXPECT_TRUE(LatestViews(map_, object(), 0).empty());
}

TEST_F(ObjectViews, PointsAreInTheWorld) {
  const auto points = CollectPoints(CollectViews(map_, object()), 100);
  EXPECT_GT(points.size(), 80u);
  EXPECT_LT(points.size(), 200u);
  for (const Eigen::Vector3d& point : points) {
    EXPECT_NEAR(made_.ellipsoid.RadialDistance(point), 0.0, 1e-4);
  }
}

TEST_F(ObjectViews, TheCentroidLiesOnTheCamerasSide) {
  const ObjectView view = CollectViews(map_, object()).front();
  const Eigen::Vector3d camera = Inverse(view.cam_from_world).translation;
  EXPECT_GT(Centroid(view).dot(camera.normalized()), 0.01);
  const Detection empty;
  EXPECT_THROW(Centroid({KeyframeId(), Rigid3(), &empty}), CheckError);
}

TEST_F(ObjectViews, ParallaxIsTheLargestAngle) {
  const auto views = CollectViews(map_, object());
  const Eigen::Vector3d a = Inverse(views.front().cam_from_world).translation;
  const Eigen::Vector3d b = Inverse(views.back().cam_from_world).translation;
  const double angle = std::acos(a.normalized().dot(b.normalized())) * 180.0 / std::numbers::pi;
  EXPECT_NEAR(Parallax(views, Eigen::Vector3d::Zero()), angle, 1e-6);
  EXPECT_NEAR(Parallax(std::span(views).first(1), Eigen::Vector3d::Zero()), 0.0, 1e-6);
}

class LandmarkViews : public ::testing::Test {
 protected:
  // Two views, `degrees` apart.
  std::vector<ObjectView> Views(double degrees) {
    map_ = Map();
    const ObjectId object = map_.AddObject();
    for (const double angle : {0.0, degrees * std::numbers::pi / 180.0}) {
      const Rigid3 pose = CameraOnCircle(angle, 1.5, 0.0);
      map_.AddObservation(object, textured_.AddObserver(map_, sensor_, pose), 0);
    }
    std::vector<ObjectView> views = CollectViews(map_, map_.objects().At(object));
    AddSurfaceLandmarks(map_, views);
    return views;
  }
  Sensor sensor_ = MakeObjectSensor();
  TexturedObject textured_{MakeObject("cup", {0.0, 0.0, 0.0}, {0.05, 0.06, 0.08}),
                           CameraOnCircle(0.0, 1.5, 0.0), 7};
  Map map_;
};

TEST_F(LandmarkViews, HaveTheLandmarksInTheCamera) {
  for (const ObjectView& view : Views(3.0)) {
    ASSERT_EQ(view.landmarks.size(), 7u);
    for (size_t i = 0; i < 7; ++i) {
      EXPECT_LT((view.landmarks[i] - view.cam_from_world * textured_.points()[i]).norm(), 1e-9);
    }
    EXPECT_EQ(SurfacePoints(view).size(), 7u);
    // The depth is between that of the nearest point of the surface and that of the centre.
    const double depth = LandmarkDepth(view).value();
    EXPECT_GT(depth, 1.5 - 0.08);
    EXPECT_LT(depth, 1.5);
  }
}

TEST_F(LandmarkViews, LeaveOutLandmarksWithLittleParallax) {
  for (const ObjectView& view : Views(1.0)) {
    EXPECT_TRUE(view.landmarks.empty());
    EXPECT_FALSE(LandmarkDepth(view));
  }
}

TEST_F(LandmarkViews, HaveNoLandmarksBeforeAddSurfaceLandmarks) {
  Views(3.0);
  EXPECT_TRUE(CollectViews(map_, map_.objects().At(ObjectId(0))).front().landmarks.empty());
}

TEST_F(LandmarkViews, DepthPointsTakePrecedence) {
  ObjectView view = Views(3.0).front();
  Detection detection = *view.detection;
  detection.points = std::vector<Eigen::Vector3d>(1, {0.0, 0.0, 1.0});
  view.detection = &detection;
  EXPECT_EQ(SurfacePoints(view), std::vector<Eigen::Vector3d>(1, {0.0, 0.0, 1.0}));
}

TEST(LandmarkDepth, IsTheMedianOfThreeOrMore) {
  const Detection detection;
  ObjectView view{KeyframeId(0), Rigid3(), &detection};
  view.landmarks = {{0.0, 0.0, 1.0}, {0.0, 0.0, 9.0}};
  EXPECT_FALSE(LandmarkDepth(view));
  view.landmarks.emplace_back(0.0, 0.0, 2.0);
  EXPECT_EQ(LandmarkDepth(view), 2.0);
}

TEST(HasDepth, NeedsEnoughPointsInAllViewsTogether) {
  Detection detection;
  detection.points = std::vector<Eigen::Vector3d>(kMinDepthPoints / 2);
  const ObjectView view{KeyframeId(0), Rigid3(), &detection};
  EXPECT_FALSE(HasDepth(std::vector{view}));
  EXPECT_TRUE(HasDepth(std::vector{view, view}));
}

TEST(MeanDistance, IsThatFromTheCameras) {
  const Detection detection;
  const std::vector<ObjectView> views = {
      {KeyframeId(0), Rigid3(), &detection},
      {KeyframeId(1), Rigid3(Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.0}), &detection}};
  EXPECT_DOUBLE_EQ(MeanDistance(views, {0.0, 0.0, 3.0}), 4.0);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/shutter_correction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

constexpr uint32_t kFrame = 31;

// A camera on the path of the synthetic world that was tracked until the frame before `kFrame`.
class ShutterCorrection : public testing::TestWithParam<double> {  // share of points with depth
 protected:
  explicit ShutterCorrection(double depth_share, double readout_time = 0.03)
      : world_({.depth_share = depth_share, .readout_time = readout_time}),
        made_(MakeSyntheticMap(world_, {10, 20, 40})) {
    const SyntheticView view = world_.Observe(kFrame - 1);
    last_.frame = view.frame;
    for (const uint32_t point : view.points) {
      last_.landmarks.push_back(made_.landmarks[point]);
    }
    last_.cam_from_world = SyntheticWorld::CamFromWorld(kFrame - 1);
    last_.motion = CameraMotion{
        last_.cam_from_world * Inverse(SyntheticWorld::CamFromWorld(kFrame - 2)), 1.0 / 30.0};
  }
  ShutterCorrection() : ShutterCorrection(GetParam()) {}

  // Root mean square of the distances between the keypoints and the pixels at which the middle row
  // sees their points.
  double ErrorOf(const Frame& frame, const SyntheticView& view) const {
    double sum = 0.0;
    for (size_t i = 0; i < view.points.size(); ++i) {
      const Eigen::Vector2d pixel = world_.sensor().camera.Project(
          SyntheticWorld::CamFromWorld(kFrame) * world_.points()[view.points[i]]);
      const auto& seen = frame.features.keypoints[i].undistorted;
      sum += (pixel - seen.cast<double>()).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(view.points.size()));
  }

  SyntheticWorld world_;
  SyntheticMap made_;
  LastFrame last_;
};

// The points are at random distances of 2 to 6 m, so the depths of neighbouring points tell the
// depth of a point only roughly.
TEST_P(ShutterCorrection, MovesKeypointsToWhereTheMiddleRowSeesThem) {
  const SyntheticView view = world_.Observe(kFrame);
  const auto corrected = PredictGlobalShutter(view.frame, made_.map, world_.sensor(), last_);
  const double before = ErrorOf(*view.frame, view);
  const double after = ErrorOf(*corrected, view);
  EXPECT_GT(before, 0.15);
  EXPECT_LT(after, GetParam() == 1.0 ? 0.1 * before : 0.5 * before);
}

TEST_P(ShutterCorrection, NeedsAKnownVelocity) {
  const SyntheticView view = world_.Observe(kFrame);
  LastFrame still = last_;
  still.motion.reset();
  EXPECT_EQ(PredictGlobalShutter(view.frame, made_.map, world_.sensor(), still), view.frame);
  // The last motion is too long ago.
  const SyntheticView later = world_.Observe(kFrame + 100);
  EXPECT_EQ(PredictGlobalShutter(later.frame, made_.map, world_.sensor(), last_), later.frame);
}

// The estimate has the error that tracking leaves, so the motion that follows from it is nearly the
// true one.
TEST_P(ShutterCorrection, AnEstimateIsBetterThanAPrediction) {
  const SyntheticView view = world_.Observe(kFrame);
  PoseEstimate estimate;
  estimate.cam_from_world = SyntheticWorld::CamFromWorld(kFrame + 0.02);
  for (const uint32_t point : view.points) {
    estimate.landmarks.push_back(made_.landmarks[point]);
  }
  const auto measured =
      MeasureGlobalShutter(view.frame, made_.map, world_.sensor(), last_, estimate);
  EXPECT_LT(ErrorOf(*measured, view), 0.1 * ErrorOf(*view.frame, view));
}

// A wrong landmark may be in the plane of the camera, where its pixel is not defined.
TEST_P(ShutterCorrection, KeypointsStayFiniteWithLandmarksThatAreNotInFront) {
  const SyntheticView view = world_.Observe(kFrame);
  PoseEstimate estimate;
  estimate.landmarks.resize(view.points.size());
  estimate.landmarks[0] = made_.map.AddLandmark(Eigen::Vector3d::Zero(), KeyframeId(0));
  estimate.landmarks[1] = made_.map.AddLandmark({0.0, 0.0, -3.0}, KeyframeId(0));
  const auto measured =
      MeasureGlobalShutter(view.frame, made_.map, world_.sensor(), last_, estimate);
  for (const Keypoint& keypoint : measured->features.keypoints) {
    ASSERT_TRUE(keypoint.undistorted.allFinite());
  }
}

TEST_P(ShutterCorrection, OfAnEstimateNeedsTheFrameBefore) {
  const SyntheticView later = world_.Observe(kFrame + 1);
  PoseEstimate estimate;
  estimate.landmarks.resize(later.points.size());
  EXPECT_EQ(MeasureGlobalShutter(later.frame, made_.map, world_.sensor(), last_, estimate),
            later.frame);
}

// Views of an initial map, four frames apart, and their points.
InitialMap MakeViews(const SyntheticWorld& world, std::vector<SyntheticView>& seen) {
  InitialMap map;
  for (const Eigen::Vector3d& position : world.points()) {
    map.points.push_back({.position = position, .observations = {}});
  }
  for (const uint32_t index : {kFrame - 4, kFrame, kFrame + 4}) {
    seen.push_back(world.Observe(index));
    const std::vector<uint32_t>& points = seen.back().points;
    for (uint32_t keypoint = 0; keypoint < points.size(); ++keypoint) {
      map.points[points[keypoint]].observations.push_back({map.views.size(), keypoint});
    }
    map.views.push_back({seen.back().frame, SyntheticWorld::CamFromWorld(index)});
  }
  return map;
}

TEST_P(ShutterCorrection, CorrectsTheViewsOfAnInitialMap) {
  std::vector<SyntheticView> seen;
  InitialMap map = MakeViews(world_, seen);
  CorrectViews(world_.sensor(), map);
  ASSERT_EQ(map.views.size(), 3u);
  const double before = ErrorOf(*seen[1].frame, seen[1]);
  EXPECT_LT(ErrorOf(*map.views[1].frame, seen[1]), GetParam() == 1.0 ? 0.1 * before : 0.5 * before);
  for (size_t i = 0; i < map.views.size(); ++i) {
    EXPECT_NE(map.views[i].frame, seen[i].frame);
    EXPECT_EQ(map.views[i].frame->id, seen[i].frame->id);
  }
}

INSTANTIATE_TEST_SUITE_P(DepthShares, ShutterCorrection, testing::Values(1.0, 0.0));

class GlobalShutterCamera : public ShutterCorrection {
 protected:
  GlobalShutterCamera() : ShutterCorrection(1.0, 0.0) {}
};

TEST_F(GlobalShutterCamera, KeepsTheFrame) {
  const SyntheticView view = world_.Observe(kFrame);
  EXPECT_EQ(PredictGlobalShutter(view.frame, made_.map, world_.sensor(), last_), view.frame);
  PoseEstimate estimate;
  estimate.landmarks.resize(view.points.size());
  EXPECT_EQ(MeasureGlobalShutter(view.frame, made_.map, world_.sensor(), last_, estimate),
            view.frame);
  InitialMap map;
  map.views = {{view.frame, Rigid3()}};
  CorrectViews(world_.sensor(), map);
  EXPECT_EQ(map.views[0].frame, view.frame);
}

}  // namespace
}  // namespace hullslam

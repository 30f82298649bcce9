// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/shutter_correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "support/fisheye_camera.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

Sensor MadeSensor() {
  Sensor sensor;
  sensor.bounds = {.min_x = -10.0, .min_y = 0.0, .max_x = 630.0, .max_y = 480.0};
  return sensor;
}

const Sensor kSensor = MadeSensor();

TEST(SeenDepths, AreTheMeansOfCells) {
  SeenDepths seen(kSensor);
  seen.Add({12.0, 10.0}, 2.0);
  seen.Add({20.0, 30.0}, 4.0);
  seen.Add({500.0, 400.0}, 1.0);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt({1.0, 1.0}), (0.5 + 0.25) / 2.0);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt({505.0, 405.0}), 1.0);
}

TEST(SeenDepths, OfAnEmptyCellAreThoseOfTheImage) {
  SeenDepths seen(kSensor);
  EXPECT_EQ(seen.InverseDepthAt({300.0, 200.0}), 0.0);
  seen.Add({12.0, 10.0}, 2.0);
  seen.Add({500.0, 400.0}, 1.0);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt({300.0, 200.0}), 0.75);
}

TEST(SeenDepths, LeaveOutPointsThatAreNotInFrontOfTheCamera) {
  SeenDepths seen(kSensor);
  seen.Add({12.0, 10.0}, 0.0);
  seen.Add({12.0, 10.0}, -1.0);
  EXPECT_EQ(seen.InverseDepthAt({12.0, 10.0}), 0.0);
}

TEST(SeenDepths, TakePixelsOutsideTheImageToBeAtItsBorder) {
  SeenDepths seen(kSensor);
  seen.Add({-50.0, 900.0}, 2.0);
  seen.Add({600.0, 10.0}, 1.0);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt({0.0, 479.0}), 0.5);
}

TEST(SeenDepths, KeypointsOfKnownDepthKeepIt) {
  SeenDepths seen(kSensor);
  seen.Add({100.0, 100.0}, 2.0);
  FrameFeatures features;
  features.keypoints = {{.undistorted = {100.0F, 100.0F}}, {.undistorted = {101.0F, 100.0F}}};
  features.depth = {4.0F, 0.0F};
  EXPECT_EQ(seen.InverseDepths(features), (std::vector<double>{0.25, 0.5}));
}

// The undistorted image of a fisheye lens is so wide that its middle would have very few cells.
TEST(SeenDepths, CellsOfAFisheyeLensAreThoseOfTheRawImage) {
  Sensor sensor;
  sensor.camera = FisheyeCamera();
  sensor.bounds = sensor.camera.UndistortedBounds();
  SeenDepths seen(sensor);
  seen.Add(sensor.camera.Undistort({330.0, 250.0}), 2.0);
  seen.Add(sensor.camera.Undistort({370.0, 250.0}), 4.0);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt(sensor.camera.Undistort({350.0, 270.0})), 0.5);
  EXPECT_DOUBLE_EQ(seen.InverseDepthAt(sensor.camera.Undistort({390.0, 270.0})), 0.25);
}

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
    last_.velocity =
        TimedVelocity{MeanVelocity(last_.motion->cam_from_last_cam, last_.motion->duration),
                      last_.motion->duration, last_.frame->timestamp};
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

  std::vector<LandmarkId> Landmarks(const SyntheticView& view) const {
    std::vector<LandmarkId> landmarks;
    for (const uint32_t point : view.points) {
      landmarks.push_back(made_.landmarks[point]);
    }
    return landmarks;
  }
  PoseEstimate EstimateOf(const Rigid3& cam_from_world, const SyntheticView& view) const {
    PoseEstimate estimate;
    estimate.cam_from_world = cam_from_world;
    estimate.landmarks = Landmarks(view);
    return estimate;
  }
  // The corrected frame of a view that has another time stamp; AsRead() if it is not corrected.
  std::shared_ptr<const Frame> Measured(const SyntheticView& view, double timestamp) {
    as_read_ = WithStamp(*view.frame, timestamp);
    return MeasureGlobalShutter(as_read_, made_.map, sensor_, last_,
                                EstimateOf(SyntheticWorld::CamFromWorld(kFrame), view));
  }
  std::shared_ptr<const Frame> Predicted(const SyntheticView& view, double timestamp) {
    as_read_ = WithStamp(*view.frame, timestamp);
    return PredictGlobalShutter(as_read_, made_.map, sensor_, last_);
  }
  const std::shared_ptr<const Frame>& AsRead() const { return as_read_; }
  static std::shared_ptr<const Frame> WithStamp(const Frame& frame, double timestamp) {
    auto stamped = std::make_shared<Frame>(frame);
    stamped->timestamp = timestamp;
    return stamped;
  }

  SyntheticWorld world_;
  Sensor sensor_ = world_.sensor();
  SyntheticMap made_;
  LastFrame last_;
  std::shared_ptr<const Frame> as_read_;
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
  still.velocity.reset();
  EXPECT_EQ(PredictGlobalShutter(view.frame, made_.map, world_.sensor(), still), view.frame);
  // The last motion is too long ago.
  const SyntheticView later = world_.Observe(kFrame + 100);
  EXPECT_EQ(PredictGlobalShutter(later.frame, made_.map, world_.sensor(), last_), later.frame);
}

// The camera moves by 0.02 m from image to image, but the stamps of two images are so close
// together that it would have moved at 20 m/s.
TEST_P(ShutterCorrection, ImagesThatAreTooCloseInTimeGiveNoVelocity) {
  const SyntheticView view = world_.Observe(kFrame);
  EXPECT_NE(Measured(view, last_.frame->timestamp + 0.031), AsRead());
  EXPECT_EQ(Measured(view, last_.frame->timestamp + 0.001), AsRead());
  EXPECT_EQ(Measured(view, last_.frame->timestamp + 0.025), AsRead()) << "the readout takes longer";
}

// With a short readout time, less than half of the usual interval is too short: then the velocity
// would be more than twice too large, and the frame as read would be nearer to the truth.
TEST_P(ShutterCorrection, LessThanHalfOfTheUsualIntervalGivesNoVelocity) {
  sensor_.readout_time = -0.005;
  const SyntheticView view = world_.Observe(kFrame);
  EXPECT_NE(Measured(view, last_.frame->timestamp + 0.52 / 30.0), AsRead());
  EXPECT_EQ(Measured(view, last_.frame->timestamp + 0.48 / 30.0), AsRead());
}

// The mean velocity over a long time differs from the current one.
TEST_P(ShutterCorrection, AGapGivesNoVelocity) {
  const SyntheticView view = world_.Observe(kFrame);
  EXPECT_NE(Measured(view, last_.frame->timestamp + 0.39), AsRead());
  EXPECT_EQ(Measured(view, last_.frame->timestamp + 0.41), AsRead());
  EXPECT_NE(Predicted(view, last_.frame->timestamp + 3.9 / 30.0), AsRead());
  EXPECT_EQ(Predicted(view, last_.frame->timestamp + 4.1 / 30.0), AsRead());
  last_.velocity->duration = 0.2;
  EXPECT_NE(Predicted(view, last_.frame->timestamp + 0.39), AsRead());
  EXPECT_EQ(Predicted(view, last_.frame->timestamp + 0.41), AsRead());
}

// Between two images the view may not move by more than half of the image, which is 0.5 radians.
TEST_P(ShutterCorrection, ImagesThatShareLittleGiveNoVelocity) {
  const SyntheticView view = world_.Observe(kFrame);
  const auto turned = [&](double angle) {
    const Rigid3 turn(ExpSo3(Eigen::Vector3d(0.0, angle, 0.0)), Eigen::Vector3d::Zero());
    return MeasureGlobalShutter(view.frame, made_.map, sensor_, last_,
                                EstimateOf(turn * last_.cam_from_world, view));
  };
  last_.velocity.reset();
  EXPECT_NE(turned(0.35), view.frame);
  EXPECT_EQ(turned(0.6), view.frame);
}

// The velocity may change by 30 px from one image to the next, which is 0.06 radians.
TEST_P(ShutterCorrection, AVelocityThatChangesAtOnceIsNotBelieved) {
  const SyntheticView view = world_.Observe(kFrame);
  const auto turned = [&](double angle) {
    const Rigid3 turn(ExpSo3(Eigen::Vector3d(0.0, angle, 0.0)), Eigen::Vector3d::Zero());
    return MeasureGlobalShutter(
        view.frame, made_.map, sensor_, last_,
        EstimateOf(turn * last_.motion->cam_from_last_cam * last_.cam_from_world, view));
  };
  EXPECT_NE(turned(0.04), view.frame);
  EXPECT_EQ(turned(0.09), view.frame);
  EXPECT_EQ(turned(-0.09), view.frame);
  last_.velocity->timestamp -= 0.2;
  EXPECT_NE(turned(0.09), view.frame) << "the velocity was another one long ago";
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

// A frame that tracking has found, with its landmarks.
class ShutterOfATrackedFrame : public ShutterCorrection {
 protected:
  ShutterOfATrackedFrame() : ShutterCorrection(1.0) {
    tracking_.estimate = EstimateOf(SyntheticWorld::CamFromWorld(kFrame), view_);
    for (const LandmarkId landmark : tracking_.estimate.landmarks) {
      tracking_.estimate.inliers += landmark.IsValid() ? 1 : 0;
    }
    made_.map.keyframes().ForEach(
        [&](KeyframeId id, const Keyframe&) { tracking_.reference = id; });
  }
  CorrectedFrame Correct() {
    return CorrectShutter(view_.frame, predicted_, made_.map,
                          {sensor_, options_, objects_, index_, 0}, last_, tracking_);
  }
  // The frame, its velocity and its pose are as before the correction.
  void ExpectNotCorrected() {
    const PoseEstimate before = tracking_.estimate;
    const CorrectedFrame result = Correct();
    EXPECT_EQ(result.frame, predicted_);
    ASSERT_TRUE(result.velocity);
    EXPECT_EQ(result.velocity->timestamp, last_.frame->timestamp);
    EXPECT_EQ(tracking_.estimate.inliers, before.inliers);
    EXPECT_EQ(tracking_.estimate.landmarks, before.landmarks);
    EXPECT_EQ(tracking_.estimate.cam_from_world.ToMatrix(), before.cam_from_world.ToMatrix());
  }

  const SyntheticView view_ = world_.Observe(kFrame);
  const std::shared_ptr<const Frame> predicted_ = std::make_shared<Frame>(*view_.frame);
  TrackingOptions options_;
  ObjectOptions objects_;
  ObjectIndex index_;
  LocalTracking tracking_;
};

TEST_F(ShutterOfATrackedFrame, IsCorrectedByTheVelocityUntilNow) {
  tracking_.estimate.cam_from_world = SyntheticWorld::CamFromWorld(kFrame + 0.1);
  const int before = tracking_.estimate.inliers;
  const CorrectedFrame result = Correct();
  EXPECT_LT(ErrorOf(*result.frame, view_), 0.3 * ErrorOf(*view_.frame, view_));
  EXPECT_EQ(tracking_.estimate.inliers, before);
  const Rigid3 truth = SyntheticWorld::CamFromWorld(kFrame);
  EXPECT_LT((tracking_.estimate.cam_from_world.translation - truth.translation).norm(), 1e-3);
  ASSERT_TRUE(result.velocity);
  EXPECT_EQ(result.velocity->timestamp, view_.frame->timestamp);
  EXPECT_LT((result.velocity->velocity.linear - last_.velocity->velocity.linear).norm(), 0.05);
}

// The last frame was taken somewhere else, so that the velocity is wrong.
TEST_F(ShutterOfATrackedFrame, StaysAsTrackedIfFewerLandmarksAgree) {
  last_.cam_from_world = SyntheticWorld::CamFromWorld(kFrame - 40);
  last_.velocity = TimedVelocity{
      MeanVelocity(tracking_.estimate.cam_from_world * Inverse(last_.cam_from_world), 1.0 / 30.0),
      1.0 / 30.0, last_.frame->timestamp};
  ExpectNotCorrected();
}

TEST_F(ShutterOfATrackedFrame, StaysAsTrackedIfTheStampIsWrong) {
  auto early = std::make_shared<Frame>(*last_.frame);
  early->timestamp = view_.frame->timestamp - 1e-6;
  last_.frame = early;
  last_.velocity->timestamp = early->timestamp;
  ExpectNotCorrected();
}

// Landmarks that were chosen for the frame as tracked do not suit the corrected one. There, other
// landmarks do.
TEST_F(ShutterOfATrackedFrame, IsJudgedByLandmarksChosenForIt) {
  const LocalTracking right = tracking_;
  std::vector<LandmarkId>& landmarks = tracking_.estimate.landmarks;
  std::reverse(landmarks.begin(), landmarks.begin() + landmarks.size() / 5);
  EXPECT_NE(Correct().frame, predicted_);
  EXPECT_GE(tracking_.estimate.inliers, 0.95 * right.estimate.inliers);
}

// A map of one frame as read contradicts the first frame that can be corrected. A map of more
// frames judges, even if the velocity was not known for a while.
TEST_F(ShutterOfATrackedFrame, TheFirstOneIsNotJudgedByAMapOfOneFrameAsRead) {
  tracking_.estimate.inliers *= 2;  // as many agree with the frame as read
  ExpectNotCorrected();
  last_.velocity.reset();
  EXPECT_EQ(Correct().frame, predicted_);
  std::vector<KeyframeId> others;
  made_.map.keyframes().ForEach([&](KeyframeId id, const Keyframe&) {
    if (id != tracking_.reference) {
      others.push_back(id);
    }
  });
  for (const KeyframeId id : others) {
    made_.map.RemoveKeyframe(id);
  }
  EXPECT_NE(Correct().frame, predicted_);
}

TEST_F(ShutterOfATrackedFrame, NeedsTheLeastNumberOfInliers) {
  const int inliers = tracking_.estimate.inliers;
  options_.min_inliers = inliers + 1;
  ExpectNotCorrected();
  options_.min_inliers = 30;
  EXPECT_NE(Correct().frame, predicted_);
}

// The same change in radians is 60 px in an image of twice the width.
TEST_P(ShutterCorrection, TheMostChangeOfTheVelocityGrowsWithTheImage) {
  const SyntheticView view = world_.Observe(kFrame);
  const Rigid3 turn(ExpSo3(Eigen::Vector3d(0.0, 0.09, 0.0)), Eigen::Vector3d::Zero());
  const PoseEstimate estimate =
      EstimateOf(turn * last_.motion->cam_from_last_cam * last_.cam_from_world, view);
  EXPECT_EQ(MeasureGlobalShutter(view.frame, made_.map, sensor_, last_, estimate), view.frame);
  sensor_.camera.width *= 2;
  EXPECT_NE(MeasureGlobalShutter(view.frame, made_.map, sensor_, last_, estimate), view.frame);
}

// A camera that turns about its vertical axis, with keypoints all over the image. The bounds of its
// motion are pixels of the raw image.
class TurningCamera : public testing::Test {
 protected:
  void Make(const PinholeCamera& camera) {
    sensor_.camera = camera;
    sensor_.bounds = camera.UndistortedBounds();
    sensor_.readout_time = 0.02;
    auto frame = std::make_shared<Frame>();
    frame->id = FrameId(1);
    frame->timestamp = 1.0;
    for (int x = 20; x < camera.width; x += 40) {
      for (int y = 20; y < camera.height; y += 40) {
        if (camera.SeesRaw({x, y})) {
          frame->features.keypoints.push_back(
              {.undistorted = camera.Undistort({x, y}).cast<float>()});
        }
      }
    }
    const size_t count = frame->features.size();
    frame->features.descriptors.resize(count);
    frame->features.depth.resize(count, 0.0F);
    frame_ = frame;
    auto before = std::make_shared<Frame>();
    before->id = FrameId(0);
    before->timestamp = frame->timestamp - 1.0 / sensor_.frames_per_second;
    last_.frame = before;
  }
  // Whether the shutter is corrected if the median keypoint has moved so far since the last image,
  // px, and with `before` moved so far in the interval before that.
  bool IsCorrected(double pixels, std::optional<double> before = std::nullopt) {
    const double interval = 1.0 / sensor_.frames_per_second;
    if (before) {
      last_.velocity = TimedVelocity{{AngleOf(*before) / interval * Eigen::Vector3d::UnitY(), {}},
                                     interval,
                                     last_.frame->timestamp};
      last_.velocity->velocity.linear.setZero();
    }
    PoseEstimate estimate;
    estimate.cam_from_world.rotation = ExpSo3(AngleOf(pixels) * Eigen::Vector3d::UnitY());
    estimate.landmarks.resize(frame_->features.size());
    return MeasureGlobalShutter(frame_, map_, sensor_, last_, estimate) != frame_;
  }

 private:
  // The angle of a turn by which the median keypoint moves so far in the raw image.
  double AngleOf(double pixels) const {
    constexpr double kStep = 1e-4;  // rad
    std::vector<double> moved;
    for (const Keypoint& keypoint : frame_->features.keypoints) {
      const Eigen::Vector2d pixel = keypoint.undistorted.cast<double>();
      const Eigen::Vector3d ray = sensor_.camera.Unproject(pixel, 1.0);
      const Eigen::Vector2d now =
          sensor_.camera.Project(ExpSo3(kStep * Eigen::Vector3d::UnitY()) * ray);
      moved.push_back((sensor_.camera.Distort(now) - sensor_.camera.Distort(pixel)).norm());
    }
    std::ranges::nth_element(moved, moved.begin() + static_cast<ptrdiff_t>(moved.size() / 2));
    return pixels / moved[moved.size() / 2] * kStep;
  }

  Sensor sensor_ = SyntheticSensor();
  Map map_;
  LastFrame last_;
  std::shared_ptr<const Frame> frame_;
};

TEST_F(TurningCamera, MayMoveByHalfOfTheRawImage) {
  for (const PinholeCamera& camera : {SyntheticSensor().camera, FisheyeCamera()}) {
    Make(camera);
    EXPECT_TRUE(IsCorrected(225.0)) << camera.IsFisheye();
    EXPECT_FALSE(IsCorrected(255.0)) << camera.IsFisheye();
  }
}

TEST_F(TurningCamera, MayChangeItsMotionByThirtyRawPixels) {
  for (const PinholeCamera& camera : {SyntheticSensor().camera, FisheyeCamera()}) {
    Make(camera);
    EXPECT_TRUE(IsCorrected(100.0, 72.0)) << camera.IsFisheye();
    EXPECT_TRUE(IsCorrected(100.0, 128.0)) << camera.IsFisheye();
    EXPECT_FALSE(IsCorrected(100.0, 68.0)) << camera.IsFisheye();
    EXPECT_FALSE(IsCorrected(100.0, 132.0)) << camera.IsFisheye();
  }
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
  CorrectFrames(world_.sensor(), map);
  ASSERT_EQ(map.views.size(), 3u);
  const double before = ErrorOf(*seen[1].frame, seen[1]);
  EXPECT_LT(ErrorOf(*map.views[1].frame, seen[1]), GetParam() == 1.0 ? 0.1 * before : 0.5 * before);
  for (size_t i = 0; i < map.views.size(); ++i) {
    EXPECT_NE(map.views[i].frame, seen[i].frame);
    EXPECT_EQ(map.views[i].frame->id, seen[i].frame->id);
  }
}

// Two views are four frames apart, but their stamps are not, so none of the velocities is right.
TEST_P(ShutterCorrection, LeavesTheViewsOfAnInitialMapIfTheirStampsAreWrong) {
  for (const double interval : {0.04, 0.1, 1.7}) {
    std::vector<SyntheticView> seen;
    InitialMap map = MakeViews(world_, seen);
    for (size_t i = 0; i < map.views.size(); ++i) {
      map.views[i].frame = WithStamp(*map.views[i].frame, static_cast<double>(i) * interval);
    }
    const std::vector<InitialMap::View> as_read = map.views;
    CorrectFrames(world_.sensor(), map);
    for (size_t i = 0; i < map.views.size(); ++i) {
      EXPECT_EQ(map.views[i].frame, as_read[i].frame) << interval;
    }
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
  CorrectFrames(world_.sensor(), map);
  EXPECT_EQ(map.views[0].frame, view.frame);
}

}  // namespace

}  // namespace hullslam

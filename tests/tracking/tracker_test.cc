// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/tracker.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <variant>

#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/landmark_edits.h"
#include "mapping/keyframe_insertion.h"
#include "objects/made_objects.h"
#include "support/ring_world.h"
#include "support/synthetic_world.h"
#include "support/test_cameras.h"
#include "support/unknown_points.h"
#include "tracking/sources/pose_source.h"

namespace hullslam {
namespace {

TEST(SightingCounter, IsEmptyAtFirst) { EXPECT_TRUE(SightingCounter().Take().empty()); }

TEST(SightingCounter, CountsPerLandmarkInOrderOfId) {
  SightingCounter counter;
  counter.CountVisible(LandmarkId(900));
  counter.CountVisible(LandmarkId(3));
  counter.CountVisible(LandmarkId(900));
  counter.CountFound(LandmarkId(900));
  counter.CountFound(LandmarkId(7));
  const std::vector<Sighting> sightings = counter.Take();
  ASSERT_EQ(sightings.size(), 3u);
  EXPECT_EQ(sightings[0].landmark, LandmarkId(3));
  EXPECT_EQ(sightings[0].visible, 1);
  EXPECT_EQ(sightings[0].found, 0);
  EXPECT_EQ(sightings[1].landmark, LandmarkId(7));
  EXPECT_EQ(sightings[1].visible, 0);
  EXPECT_EQ(sightings[1].found, 1);
  EXPECT_EQ(sightings[2].landmark, LandmarkId(900));
  EXPECT_EQ(sightings[2].visible, 2);
  EXPECT_EQ(sightings[2].found, 1);
}

TEST(SightingCounter, StartsAgainFromZeroAfterTake) {
  SightingCounter counter;
  counter.CountVisible(LandmarkId(5));
  counter.CountVisible(LandmarkId(1));
  counter.Take();
  EXPECT_TRUE(counter.Take().empty());
  counter.CountFound(LandmarkId(5));
  const std::vector<Sighting> sightings = counter.Take();
  ASSERT_EQ(sightings.size(), 1u);
  EXPECT_EQ(sightings[0].landmark, LandmarkId(5));
  EXPECT_EQ(sightings[0].visible, 0) << "what was taken is not counted again";
  EXPECT_EQ(sightings[0].found, 1);
}

constexpr MapperStatus kIdle;

std::shared_ptr<const Map> Publish(Map& map) { return std::make_shared<const Map>(map.Snapshot()); }

// A frame with only the given keypoints of another frame.
std::shared_ptr<Frame> Select(const Frame& frame, const std::vector<uint32_t>& keypoints) {
  auto selected = std::make_shared<Frame>();
  selected->id = frame.id;
  selected->timestamp = frame.timestamp;
  for (const uint32_t i : keypoints) {
    selected->features.keypoints.push_back(frame.features.keypoints[i]);
    selected->features.descriptors.push_back(frame.features.descriptors[i]);
    selected->features.depth.push_back(frame.features.depth[i]);
  }
  return selected;
}

std::vector<uint32_t> AllKeypoints(const Frame& frame) {
  std::vector<uint32_t> all(frame.features.size());
  for (uint32_t i = 0; i < all.size(); ++i) {
    all[i] = i;
  }
  return all;
}

// The request for a keyframe in the tracker's result; null if there is none.
const KeyframeRequest* RequestOf(const Tracker::Result& result) {
  return result.message ? std::get_if<KeyframeRequest>(&*result.message) : nullptr;
}

void ExpectNear(const Rigid3& a, const Rigid3& b, double tolerance) {
  EXPECT_LT((a.translation - b.translation).norm(), tolerance);
  EXPECT_LT(AngularDistance(a.rotation, b.rotation), tolerance);
}

// Fewer than 100 of the 300 points are close in a frame, so a frame with unknown close points needs
// a keyframe.
class TrackerTest : public testing::Test {
 protected:
  explicit TrackerTest(const Sensor& sensor = SyntheticSensor())
      : world_({.points = 300}, sensor), tracker_(world_.sensor(), options_) {}

  // Initialises on frame 0 and gives the tracker a map with the true positions of all points.
  void Begin() {
    ASSERT_EQ(Process(world_.Observe(0).frame).report.tracked.state, TrackingState::kTracked);
    map_ = Publish(made_.map);
  }
  Tracker::Result Process(std::shared_ptr<const Frame> frame) {
    return tracker_.Process(std::move(frame), map_, kIdle);
  }
  void TrackFrames(uint32_t first, uint32_t last) {
    for (uint32_t i = first; i <= last; ++i) {
      ASSERT_EQ(Process(world_.Observe(i).frame).report.tracked.state, TrackingState::kTracked)
          << i;
    }
  }
  // The frame of the path, with unknown close points.
  std::shared_ptr<const Frame> DemandingFrame(uint32_t index) const {
    const SyntheticView view = world_.Observe(index);
    auto frame = Select(*view.frame, AllKeypoints(*view.frame));
    AddUnknownPoints(world_.sensor(), 80, 0, *frame);
    return frame;
  }
  // Frame `index` with `known` keypoints that keyframe 0 observes too, and unknown close points.
  std::shared_ptr<const Frame> FrameWithKnown(uint32_t index, size_t known) const {
    const SyntheticView view = world_.Observe(index);
    std::vector<uint32_t> keypoints;
    for (uint32_t i = 0; i < view.points.size() && keypoints.size() < known; ++i) {
      const auto& first = made_.views[0].points;
      if (std::find(first.begin(), first.end(), view.points[i]) != first.end() &&
          made_.landmarks[view.points[i]].IsValid()) {
        keypoints.push_back(i);
      }
    }
    auto frame = Select(*view.frame, keypoints);
    AddUnknownPoints(world_.sensor(), 80, 0, *frame);
    return frame;
  }

  const SyntheticWorld world_;
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 5, 10});
  TrackingOptions options_{.keyframe_interval = 0.0};  // the next frame may be a keyframe
  Tracker tracker_;
  std::shared_ptr<const Map> map_;
};

class TrackerWith : public TrackerTest, public testing::WithParamInterface<TestCamera> {
 protected:
  TrackerWith() : TrackerTest(GetParam().sensor) {}
};

HULLSLAM_WITH_ALL_CAMERAS(TrackerWith);

// Frames with the motion from the frame before, which may be wrong by `error`.
class TrackerWithPrior : public TrackerTest {
 protected:
  std::shared_ptr<Frame> WithPrior(const std::shared_ptr<const Frame>& frame,
                                   const Rigid3& error = Rigid3()) const {
    auto result = std::make_shared<Frame>(*frame);
    const auto index = static_cast<double>(frame->id.value);
    result->motion = MotionPrior{error * SyntheticWorld::CamFromWorld(index) *
                                     Inverse(SyntheticWorld::CamFromWorld(index - 1.0)),
                                 (index - 1.0) / 30.0, 1e-6 * MotionPrior().covariance};
    return result;
  }
  std::shared_ptr<Frame> Black(uint32_t index) const {
    return WithPrior(Select(*world_.Observe(index).frame, {}));
  }
};

TEST_F(TrackerWithPrior, ARightPriorIsFused) {
  Begin();
  TrackFrames(1, 3);
  const TrackedFrame tracked = Process(WithPrior(world_.Observe(4).frame)).report.tracked;
  EXPECT_EQ(tracked.prior, PriorUse::kFused);
  ExpectNear(tracked.cam_from_world, SyntheticWorld::CamFromWorld(4), 1e-3);
}

// The result has the bits of a tracker without a prior.
TEST_F(TrackerWithPrior, AWrongPriorIsDropped) {
  Begin();
  TrackFrames(1, 3);
  Tracker other(world_.sensor(), options_);
  other.Process(world_.Observe(0).frame, nullptr, kIdle);
  for (uint32_t i = 1; i <= 3; ++i) {
    other.Process(world_.Observe(i).frame, map_, kIdle);
  }
  const Rigid3 error(ExpSo3({0.05, 0.0, 0.0}), {0.1, 0.0, 0.0});
  const TrackedFrame tracked = Process(WithPrior(world_.Observe(4).frame, error)).report.tracked;
  EXPECT_EQ(tracked.prior, PriorUse::kDropped);
  EXPECT_EQ(tracked.odometry->step, OdometryStep::kMeasured);
  const TrackedFrame without = other.Process(world_.Observe(4).frame, map_, kIdle).report.tracked;
  EXPECT_EQ(tracked.cam_from_world.translation, without.cam_from_world.translation);
}

TEST_F(TrackerWithPrior, BlackImagesAreCrossed) {
  Begin();
  TrackFrames(1, 3);
  Process(WithPrior(world_.Observe(4).frame));
  double last = 0.0;
  for (uint32_t i = 5; i <= 34; ++i) {
    const Tracker::Result result = Process(Black(i));
    const TrackedFrame& tracked = result.report.tracked;
    ASSERT_EQ(tracked.prior, PriorUse::kAlone) << i;
    EXPECT_EQ(tracked.state, TrackingState::kTracked);
    EXPECT_EQ(tracked.odometry->step, OdometryStep::kPrior);
    EXPECT_EQ(tracked.odometry->corrected_at, FrameId(0)) << "the map has not jumped";
    EXPECT_FALSE(result.message.has_value());
    ExpectNear(tracked.cam_from_world, SyntheticWorld::CamFromWorld(i), 1e-3);
    EXPECT_GT(tracked.covariance->trace(), last);
    last = tracked.covariance->trace();
  }
  const TrackedFrame found = Process(WithPrior(world_.Observe(35).frame)).report.tracked;
  EXPECT_EQ(found.prior, PriorUse::kFused);
  EXPECT_GT(found.inliers, 50);
  EXPECT_LT(found.covariance->trace(), last);
}

// The camera sees an unknown place when images are good again. It becomes a keyframe that only the
// prior ties to the others, and the next frame is found by its landmarks.
TEST_F(TrackerWithPrior, ANewPlaceAfterBlackImagesIsMapped) {
  Begin();
  TrackFrames(1, 3);
  Process(WithPrior(world_.Observe(4).frame));
  const SyntheticWorld other({.points = 300, .seed = 7}, world_.sensor());
  std::optional<MapMessage> message;
  uint32_t index = 5;
  for (; index <= 20 && !message; ++index) {
    const auto frame = index < 10 ? Black(index) : WithPrior(other.Observe(index).frame);
    Tracker::Result result = Process(frame);
    ASSERT_EQ(result.report.tracked.prior, PriorUse::kAlone) << index;
    message = std::move(result.message);
  }
  EXPECT_EQ(index, 13u) << "the third good image";
  ASSERT_TRUE(message && std::holds_alternative<KeyframeRequest>(*message));
  std::vector<LandmarkId> created;
  const KeyframeId keyframe = InsertKeyframe(made_.map, std::get<KeyframeRequest>(*message),
                                             world_.sensor(), created, MappingRule::kHullslam);
  EXPECT_TRUE(IsTied(made_.map, keyframe));
  map_ = Publish(made_.map);
  const TrackedFrame found = Process(WithPrior(other.Observe(13).frame)).report.tracked;
  EXPECT_EQ(found.prior, PriorUse::kFused);
  EXPECT_EQ(found.from_keyframe->reference, keyframe);
  EXPECT_EQ(found.odometry->step, OdometryStep::kMeasured);
  EXPECT_EQ(found.odometry->corrected_at, FrameId(0)) << "the map has not jumped";
  ExpectNear(found.cam_from_world, SyntheticWorld::CamFromWorld(13), 2e-3);
}

TEST_F(TrackerWithPrior, ANewPlaceIsNotMappedWhileOnlyLocalising) {
  Begin();
  TrackFrames(1, 4);
  tracker_.LocaliseOnly();
  const SyntheticWorld other({.points = 300, .seed = 7}, world_.sensor());
  for (uint32_t i = 5; i < 12; ++i) {
    EXPECT_FALSE(Process(WithPrior(other.Observe(i).frame)).message) << i;
  }
}

// Each step is 0.3 mm too far, with a standard deviation of 1e-12 m. Errors add up only until they
// contradict the landmarks.
TEST_F(TrackerWithPrior, ATooConfidentPriorIsDroppedBeforeItDoesHarm) {
  Begin();
  TrackFrames(1, 3);
  int dropped = 0;
  for (uint32_t i = 4; i < 40; ++i) {
    auto frame =
        WithPrior(world_.Observe(i).frame, {Eigen::Quaterniond::Identity(), {0.0003, 0.0, 0.0}});
    frame->motion->covariance = 1e-24 * MotionPrior().covariance;
    const TrackedFrame tracked = Process(frame).report.tracked;
    ASSERT_EQ(tracked.state, TrackingState::kTracked) << i;
    ExpectNear(tracked.cam_from_world, SyntheticWorld::CamFromWorld(i), 5e-3);
    ASSERT_TRUE(tracked.covariance->allFinite());
    dropped += tracked.prior == PriorUse::kDropped ? 1 : 0;
  }
  EXPECT_GT(dropped, 0);
}

// Without landmarks, a prior that they have contradicted would lead anywhere.
TEST_F(TrackerWithPrior, AContradictedPriorIsNotUsedAlone) {
  Begin();
  TrackFrames(1, 3);
  const Rigid3 error(ExpSo3({0.05, 0.0, 0.0}), {0.1, 0.0, 0.0});
  for (uint32_t i = 4; i < 8; ++i) {
    ASSERT_EQ(Process(WithPrior(world_.Observe(i).frame, error)).report.tracked.prior,
              PriorUse::kDropped);
  }
  EXPECT_EQ(Process(Black(8)).report.tracked.state, TrackingState::kLost);
}

// Each step may be wrong by 30 degrees, so after a few of them the image may show anything.
TEST_F(TrackerWithPrior, AnUncertainPoseIsLost) {
  Begin();
  TrackFrames(1, 3);
  auto frame = Black(4);
  frame->motion->covariance *= 0.25 / frame->motion->covariance(0, 0);
  EXPECT_EQ(Process(frame).report.tracked.state, TrackingState::kLost);
}

// The frames of the first keyframe have no drift. The keyframe adds its own covariance, so those
// that only see what it created are less certain.
TEST_F(TrackerTest, CovariancesGrowWithTheDriftOfTheMap) {
  Begin();
  DriftModel drift;
  PoseEstimate estimate;
  estimate.landmarks = {made_.landmarks[0]};
  estimate.information = estimate.seen_information = 4.0 * Eigen::Matrix<double, 6, 6>::Identity();
  const KeyframeId creator = map_->landmarks().At(estimate.landmarks[0]).created_by;
  EXPECT_NEAR(drift.Measured(estimate)(0, 0), 0.25, 1e-12);
  drift.Add(map_->keyframes().At(creator).frame->id, Rigid3(),
            0.5 * Eigen::Matrix<double, 6, 6>::Identity());
  EXPECT_NEAR((drift.Measured(estimate) + drift.Drift(*map_, estimate))(0, 0), 0.75, 1e-12);
}

TEST_F(TrackerTest, QualityIsHighWithManyLandmarks) {
  Begin();
  TrackFrames(1, 2);
  const TrackedFrame tracked = Process(world_.Observe(3).frame).report.tracked;
  EXPECT_GT(tracked.quality, 0.9);
  ASSERT_TRUE(tracked.covariance.has_value());
  EXPECT_GT(tracked.covariance->llt().matrixL().determinant(), 0.0);
}

// Half of the landmarks of every keyframe are common ones, the other half only this keyframe
// observes. The frame shows the common ones. So no keyframe is needed if landmarks with a single
// observation do not count.
TEST_F(TrackerTest, LandmarksOfASingleObservationAreNotExpected) {
  std::vector<uint32_t> common;  // points
  for (uint32_t point = 0; point < made_.landmarks.size(); ++point) {
    const LandmarkId id = made_.landmarks[point];
    if (!id.IsValid()) {
      continue;
    }
    const std::vector<Observation> observations = made_.map.landmarks().At(id).observations;
    if (observations.size() == 3 && point % 2 == 0) {
      common.push_back(point);
      continue;
    }
    made_.map.EraseLandmark(id);
    for (const Observation& observation : observations) {
      const LandmarkId weak = made_.map.AddLandmark(world_.points()[point], observation.keyframe);
      made_.map.AddObservation(weak, observation.keyframe, observation.keypoint);
    }
  }
  for (uint32_t i = 0; i < 3; ++i) {
    UpdateCovisibility(made_.map, KeyframeId(i));
  }
  Begin();
  const SyntheticView view = world_.Observe(11);
  std::vector<uint32_t> keypoints;
  for (uint32_t i = 0; i < view.points.size(); ++i) {
    if (std::find(common.begin(), common.end(), view.points[i]) != common.end()) {
      keypoints.push_back(i);
    }
  }
  ASSERT_GT(keypoints.size(), 60u);
  auto frame = Select(*view.frame, keypoints);
  RebuildGrid(world_.sensor(), *frame);
  const Tracker::Result result = Process(frame);
  ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked);
  EXPECT_EQ(RequestOf(result), nullptr);
}

// A camera stands still before something that is detected but can never be mapped. Whether objects
// constrain poses changes nothing about it, so that uses of objects are compared with the same
// reasons for keyframes.
class NeverMappedObject : public TrackerTest {
 protected:
  std::vector<uint32_t> Requests(const ObjectOptions& objects, bool are_reasons = true);
};

std::vector<uint32_t> NeverMappedObject::Requests(const ObjectOptions& objects, bool are_reasons) {
  TrackingOptions options = options_;
  options.keyframes_for_objects = are_reasons;
  Tracker tracker(world_.sensor(), options, objects);
  tracker.Process(world_.Observe(0).frame, nullptr, kIdle);
  const auto map = Publish(made_.map);
  const SyntheticView view = world_.Observe(10);
  std::vector<uint32_t> requests;
  for (uint32_t i = 1; i <= 600; ++i) {
    auto frame = Select(*view.frame, AllKeypoints(*view.frame));
    frame->id = FrameId(100 + i);  // no keyframe has this id
    frame->timestamp = i / 30.0;
    frame->detections.emplace_back().hull = {{10.0, 10.0}, {60.0, 10.0}, {60.0, 60.0}};
    const Tracker::Result result = tracker.Process(frame, map, kIdle);
    EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked) << i;
    if (result.message) {
      requests.push_back(i);
    }
  }
  return requests;
}

TEST_F(NeverMappedObject, CausesFewerAndFewerRequests) {
  const std::vector<uint32_t> expected = {10, 20, 30, 40, 60, 100, 180, 340, 500};
  ObjectOptions objects;
  EXPECT_EQ(Requests(objects), expected);
  objects.joint_pose = false;
  EXPECT_EQ(Requests(objects), expected);
  objects.guided_matching = false;
  EXPECT_EQ(Requests(objects), expected);
}

TEST_F(NeverMappedObject, CausesNoRequestIfObjectsAreNoReasonForKeyframes) {
  EXPECT_EQ(Requests({}, false), std::vector<uint32_t>());
}

TEST_P(TrackerWith, TheFirstFrameWithEnoughDepthDefinesTheWorldFrame) {
  const auto frame = world_.Observe(0).frame;
  const Tracker::Result result = Process(frame);
  EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked);
  EXPECT_FALSE(result.report.tracked.from_keyframe) << "it is a keyframe";
  EXPECT_EQ(result.report.tracked.frame, frame->id);
  EXPECT_EQ(result.report.tracked.timestamp, frame->timestamp);
  ExpectNear(result.report.tracked.cam_from_world, Rigid3(), 1e-15);
  ASSERT_TRUE(result.message);
  const auto* initial = std::get_if<InitialMap>(&*result.message);
  ASSERT_NE(initial, nullptr);
  ASSERT_EQ(initial->views.size(), 1u);
  EXPECT_EQ(initial->views[0].frame, frame);
  EXPECT_EQ(initial->views[0].cam_from_world.translation, Eigen::Vector3d::Zero());
  EXPECT_EQ(static_cast<int>(initial->points.size()), result.report.tracked.inliers);
  double last_depth = 0.0;
  for (const InitialMap::Point& point : initial->points) {
    ASSERT_EQ(point.observations.size(), 1u);
    const uint32_t keypoint = point.observations[0].keypoint;
    const Eigen::Vector2d pixel = frame->features.keypoints[keypoint].undistorted.cast<double>();
    EXPECT_LT((world_.sensor().camera.Project(point.position) - pixel).norm(), 1e-9);
    EXPECT_EQ(point.position.z(), static_cast<double>(frame->features.depth[keypoint]));
    EXPECT_GE(point.position.z(), last_depth) << "nearest first";
    last_depth = point.position.z();
  }
}

TEST_F(TrackerTest, InitialisesWithExactlyTheRequiredPoints) {
  const auto frame = world_.Observe(0).frame;
  const auto with_depth = std::count_if(frame->features.depth.begin(), frame->features.depth.end(),
                                        [](float z) { return z > 0.0f; });
  options_.min_initial_points = static_cast<int>(with_depth) + 1;
  Tracker strict(world_.sensor(), options_);
  const Tracker::Result refused = strict.Process(frame, nullptr, kIdle);
  EXPECT_EQ(refused.report.tracked.state, TrackingState::kNotInitialized);
  EXPECT_FALSE(refused.report.tracked.from_keyframe);
  EXPECT_FALSE(refused.message);
  options_.min_initial_points = static_cast<int>(with_depth);
  Tracker content(world_.sensor(), options_);
  EXPECT_TRUE(content.Process(frame, nullptr, kIdle).message);
}

TEST_F(TrackerTest, InitialisesLaterWhenTheFirstFramesHaveNoDepth) {
  const SyntheticWorld without_depth({.points = 300, .depth_share = 0.0});
  for (uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(Process(without_depth.Observe(i).frame).report.tracked.state,
              TrackingState::kNotInitialized);
  }
  EXPECT_TRUE(Process(world_.Observe(3).frame).message);
}

TEST_P(TrackerWith, FindsThePoseOfExactFrames) {
  Begin();
  for (uint32_t i = 1; i <= 20; ++i) {
    const Tracker::Result result = Process(world_.Observe(i).frame);
    ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked) << i;
    ExpectNear(result.report.tracked.cam_from_world, SyntheticWorld::CamFromWorld(i), 1e-6);
    ExpectNear(map_->CamFromWorld(*result.report.tracked.from_keyframe),
               result.report.tracked.cam_from_world, 1e-12);
    EXPECT_GT(result.report.tracked.inliers, 100);
  }
}

TEST_P(TrackerWith, FollowsAMapThatMoved) {
  Begin();
  TrackFrames(1, 5);
  const Rigid3 old_from_new(ExpSo3({0.3, 1.0, -0.4}), {10.0, -20.0, 5.0});
  Map moved = made_.map.Snapshot();
  map_->keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    moved.SetPose(id, keyframe.cam_from_world * old_from_new);
  });
  map_->landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    moved.SetPosition(id, Inverse(old_from_new) * landmark.position);
    UpdateViewingGeometry(moved, id, world_.sensor().levels);
  });
  map_ = Publish(moved);
  for (uint32_t i = 6; i <= 8; ++i) {
    const Tracker::Result result = Process(world_.Observe(i).frame);
    ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked) << i;
    ExpectNear(result.report.tracked.cam_from_world, SyntheticWorld::CamFromWorld(i) * old_from_new,
               1e-5);
  }
}

TEST_P(TrackerWith, ALostFrameDoesNotChangeTheReferenceKeyframe) {
  Begin();
  TrackFrames(1, 5);
  const Tracker::Result before = Process(world_.Observe(6).frame);
  ASSERT_TRUE(before.report.tracked.from_keyframe);
  const size_t too_few = static_cast<size_t>(options_.min_inliers) - 1;
  EXPECT_EQ(Process(FrameWithKnown(7, too_few)).report.tracked.state, TrackingState::kLost);
  const Tracker::Result after = Process(world_.Observe(8).frame);
  ASSERT_EQ(after.report.tracked.state, TrackingState::kTracked);
  ExpectNear(after.report.tracked.cam_from_world, SyntheticWorld::CamFromWorld(8), 1e-6);
}

TEST_P(TrackerWith, TheReportSaysWhatWasFoundInTheFrame) {
  Begin();
  const SyntheticView view = world_.Observe(1);
  const Tracker::Result result = Process(view.frame);
  EXPECT_EQ(result.report.frame, view.frame);
  ASSERT_EQ(result.report.landmarks.size(), view.points.size());
  EXPECT_EQ(result.report.objects.size(), view.frame->detections.size());
  int found = 0;
  for (size_t i = 0; i < view.points.size(); ++i) {
    if (result.report.landmarks[i].IsValid()) {
      ++found;
      EXPECT_EQ(result.report.landmarks[i], made_.landmarks[view.points[i]]);
    }
  }
  EXPECT_EQ(found, result.report.tracked.inliers);
}

TEST_F(TrackerTest, ContinuesWhenItsReferenceKeyframeIsCulled) {
  Begin();
  TrackFrames(1, 4);
  const Tracker::Result before = Process(world_.Observe(5).frame);
  ASSERT_NE(before.report.tracked.from_keyframe->reference, KeyframeId(0))
      << "the root cannot be culled";
  made_.map.CullKeyframe(before.report.tracked.from_keyframe->reference);
  map_ = Publish(made_.map);
  for (uint32_t i = 6; i <= 8; ++i) {
    const Tracker::Result result = Process(world_.Observe(i).frame);
    ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked) << i;
    EXPECT_TRUE(map_->keyframes().Contains(result.report.tracked.from_keyframe->reference));
    ExpectNear(result.report.tracked.cam_from_world, SyntheticWorld::CamFromWorld(i), 1e-6);
  }
}

TEST_P(TrackerWith, ContinuesWhenAllItsLandmarksAreReplaced) {
  Begin();
  TrackFrames(1, 5);
  for (const LandmarkId old : made_.landmarks) {
    if (old.IsValid()) {
      const Landmark landmark = map_->landmarks().At(old);
      const LandmarkId twin = made_.map.AddLandmark(landmark.position, landmark.created_by);
      made_.map.ReplaceLandmark(old, twin);
      UpdateDescriptor(made_.map, twin);
      UpdateViewingGeometry(made_.map, twin, world_.sensor().levels);
    }
  }
  map_ = Publish(made_.map);
  const Tracker::Result result = Process(DemandingFrame(6));
  ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked);
  ExpectNear(result.report.tracked.cam_from_world, SyntheticWorld::CamFromWorld(6), 1e-6);
  ASSERT_TRUE(result.message);
  for (const LandmarkId landmark : RequestOf(result)->landmarks) {
    EXPECT_TRUE(!landmark.IsValid() || map_->landmarks().Contains(landmark));
  }
}

// Every corner is found at two levels, which differ by four, and has a landmark for each level.
class TwinTest : public TrackerTest {
 protected:
  // DemandingFrame plus a twin of each of its known keypoints, appended in the same order.
  std::shared_ptr<Frame> FrameWithTwins(uint32_t index) const {
    const auto demanding = DemandingFrame(index);
    auto frame = Select(*demanding, AllKeypoints(*demanding));
    FrameFeatures& features = frame->features;
    const size_t count = world_.Observe(index).points.size();
    for (size_t i = 0; i < count; ++i) {
      Keypoint twin = features.keypoints[i];
      twin.level = twin.level >= 4 ? twin.level - 4 : twin.level + 4;
      Descriptor descriptor = features.descriptors[i];
      descriptor[0] ^= 0xffff;
      features.keypoints.push_back(twin);
      features.descriptors.push_back(descriptor);
      features.depth.push_back(features.depth[i]);
    }
    RebuildGrid(world_.sensor(), *frame);
    return frame;
  }

  // Makes the frame with twins a keyframe that observes the known landmarks and new twins of them.
  std::shared_ptr<const Frame> AddKeyframeWithTwins(uint32_t index) {
    const auto frame = FrameWithTwins(index);
    const SyntheticView view = world_.Observe(index);
    const size_t first_twin = frame->features.size() - view.points.size();
    const KeyframeId id = made_.map.AddKeyframe(frame, SyntheticWorld::CamFromWorld(index));
    for (uint32_t i = 0; i < view.points.size(); ++i) {
      const LandmarkId landmark = made_.landmarks[view.points[i]];
      if (landmark.IsValid()) {
        const LandmarkId twin = made_.map.AddLandmark(world_.points()[view.points[i]], id);
        Observe(landmark, id, i);
        Observe(twin, id, static_cast<uint32_t>(first_twin + i));
        twins_.emplace_back(landmark, twin);
      }
    }
    UpdateCovisibility(made_.map, id);
    return frame;
  }

  void Observe(LandmarkId landmark, KeyframeId keyframe, uint32_t keypoint) {
    ASSERT_TRUE(made_.map.AddObservation(landmark, keyframe, keypoint));
    UpdateDescriptor(made_.map, landmark);
    UpdateViewingGeometry(made_.map, landmark, world_.sensor().levels);
  }

  std::vector<std::pair<LandmarkId, LandmarkId>> twins_;
};

std::vector<LandmarkId> FoundLandmarks(const KeyframeRequest& request) {
  std::vector<LandmarkId> found = request.landmarks;
  std::erase(found, LandmarkId());
  std::sort(found.begin(), found.end());
  return found;
}

TEST_F(TwinTest, ALandmarkIsFoundAtOneKeypointOnlyAfterItsTwinWasReplaced) {
  Begin();
  TrackFrames(1, 14);
  const auto keyframe = AddKeyframeWithTwins(15);
  Process(keyframe);
  map_ = Publish(made_.map);
  const Tracker::Result before = Process(FrameWithTwins(16));
  ASSERT_TRUE(before.message);
  const size_t found_before = FoundLandmarks(*RequestOf(before)).size();
  for (const auto& [landmark, twin] : twins_) {
    made_.map.ReplaceLandmark(twin, landmark);
  }
  map_ = Publish(made_.map);
  const Tracker::Result after = Process(FrameWithTwins(17));
  ASSERT_TRUE(after.message);
  const std::vector<LandmarkId> found = FoundLandmarks(*RequestOf(after));
  EXPECT_GT(found.size(), 50u);
  EXPECT_GT(found_before, 3 * found.size() / 2) << "the twins were separate landmarks";
  EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
}

TEST_P(TrackerWith, IsLostInAnotherWorldAndRecoversInItsOwn) {
  Begin();
  TrackFrames(1, 5);
  const SyntheticWorld other({.points = 300, .seed = 2}, world_.sensor());
  for (uint32_t i = 6; i <= 8; ++i) {
    const Tracker::Result lost = Process(other.Observe(i).frame);
    EXPECT_EQ(lost.report.tracked.state, TrackingState::kLost);
    EXPECT_EQ(lost.report.tracked.frame, FrameId(i));
    EXPECT_FALSE(lost.report.tracked.from_keyframe);
    EXPECT_FALSE(lost.message);
  }
  const Tracker::Result found = Process(world_.Observe(9).frame);
  ASSERT_EQ(found.report.tracked.state, TrackingState::kTracked);
  ExpectNear(found.report.tracked.cam_from_world, SyntheticWorld::CamFromWorld(9), 1e-6);
  TrackFrames(10, 12);
}

TEST_P(TrackerWith, AFrameWithoutKeypointsIsLost) {
  Begin();
  auto blank = std::make_shared<Frame>();
  blank->id = FrameId(1);
  RebuildGrid(world_.sensor(), *blank);
  EXPECT_EQ(Process(blank).report.tracked.state, TrackingState::kLost);
  EXPECT_EQ(Process(world_.Observe(2).frame).report.tracked.state, TrackingState::kTracked);
}

// Only the motion model can find a frame that shows no landmark of the reference keyframe. After a
// lost or missing frame the motion is that of several frames, so it must not be used.
TEST_F(TrackerTest, TheMotionModelIsNotUsedAfterALostOrMissingFrame) {
  // Points whose landmarks only the last two keyframes observe. These observe few others, so none
  // of them becomes the reference.
  made_ = MakeSyntheticMap(world_, {0, 5, 10, 15});
  std::vector<uint32_t> chosen;
  const auto remove = [&](LandmarkId landmark, uint32_t first) {
    for (const uint32_t keyframe : {first, first + 1}) {
      if (made_.map.landmarks().Contains(landmark)) {
        made_.map.RemoveObservation(landmark, KeyframeId(keyframe));
      }
    }
  };
  const std::vector<uint32_t> points = made_.views[3].points;
  for (size_t i = 0; i < points.size(); ++i) {
    const LandmarkId landmark = made_.landmarks[points[i]];
    if (!landmark.IsValid() || made_.map.landmarks().At(landmark).observations.size() != 4) {
      continue;
    }
    if (chosen.size() < 60) {
      remove(landmark, 0);
      if (made_.map.landmarks().Contains(landmark)) {
        chosen.push_back(points[i]);
      }
    } else if (i % 8 != 0) {
      remove(landmark, 2);
    }
  }
  ASSERT_EQ(chosen.size(), 60u);
  for (uint32_t i = 0; i < 4; ++i) {
    UpdateCovisibility(made_.map, KeyframeId(i));
  }
  const auto show = [&](uint32_t index) {
    const SyntheticView view = world_.Observe(index);
    std::vector<uint32_t> keypoints;
    for (uint32_t i = 0; i < view.points.size(); ++i) {
      if (std::find(chosen.begin(), chosen.end(), view.points[i]) != chosen.end()) {
        keypoints.push_back(i);
      }
    }
    auto frame = Select(*view.frame, keypoints);
    RebuildGrid(world_.sensor(), *frame);
    return frame;
  };
  struct Case {
    std::vector<uint32_t> frames;  // frames that are tracked
    bool has_lost_frame = false;   // whether a lost frame follows them
    TrackingState expected = TrackingState::kLost;
  };
  for (const Case& given : {Case{{0, 1, 2, 3, 4}, false, TrackingState::kTracked},
                            Case{{0, 1, 2, 3, 4}, true}, Case{{0, 1, 2, 4}, false}}) {
    Tracker tracker(world_.sensor(), options_);
    const auto track = [&](std::shared_ptr<const Frame> frame) {
      const bool is_first = frame->id.value == 0;
      return tracker.Process(std::move(frame), is_first ? nullptr : Publish(made_.map), kIdle)
          .report.tracked.state;
    };
    for (const uint32_t i : given.frames) {
      ASSERT_EQ(track(world_.Observe(i).frame), TrackingState::kTracked) << i;
    }
    if (given.has_lost_frame) {
      ASSERT_EQ(track(Select(*world_.Observe(5).frame, {})), TrackingState::kLost);
    }
    // Without the motion model, only a comparison with all keyframes finds such a frame.
    const bool is_tracked = track(show(given.has_lost_frame ? 6 : 5)) == TrackingState::kTracked;
    EXPECT_EQ(is_tracked && !tracker.HasWideSteps(), given.expected == TrackingState::kTracked)
        << given.frames.size() << given.has_lost_frame;
  }
}

TEST_F(TrackerTest, TooFewInliersAreLost) {
  Begin();
  const size_t enough = static_cast<size_t>(options_.min_inliers);
  EXPECT_EQ(Process(FrameWithKnown(1, enough - 1)).report.tracked.state, TrackingState::kLost);
  const Tracker::Result result = Process(FrameWithKnown(2, enough));
  EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked);
  EXPECT_EQ(result.report.tracked.inliers, options_.min_inliers);
}

TEST_F(TrackerTest, AFewLandmarksAreEnoughIfTheOptionAllowsIt) {
  options_.min_inliers = 8;
  Tracker tracker(world_.sensor(), options_);
  tracker.Process(world_.Observe(0).frame, nullptr, kIdle);
  const auto map = Publish(made_.map);
  EXPECT_EQ(tracker.Process(FrameWithKnown(1, 7), map, kIdle).report.tracked.state,
            TrackingState::kLost);
  for (const uint32_t frame :
       {1U, 2U, 3U}) {  // first by the reference keyframe, then by the motion model
    const Tracker::Result result = tracker.Process(FrameWithKnown(frame, 8), map, kIdle);
    EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked) << frame;
    EXPECT_EQ(result.report.tracked.inliers, 8) << frame;
    EXPECT_TRUE(result.message) << frame;
  }
}

TEST_F(TrackerTest, RequestsNoKeyframeWhileTooManyRequestsWait) {
  Begin();
  EXPECT_FALSE(
      tracker_.Process(DemandingFrame(1), map_, {.is_idle = false, .requests_waiting = 3}).message);
  EXPECT_TRUE(
      tracker_.Process(DemandingFrame(2), map_, {.is_idle = false, .requests_waiting = 2}).message);
}

TEST_P(TrackerWith, ARequestHasThePoseTheLandmarksAndTheSightings) {
  Begin();
  const Tracker::Result first = Process(world_.Observe(1).frame);
  ASSERT_FALSE(first.message);
  const Tracker::Result second = Process(DemandingFrame(2));
  ASSERT_TRUE(second.message);
  const KeyframeRequest& request = *RequestOf(second);
  ExpectNear(map_->CamFromWorld(request.pose), second.report.tracked.cam_from_world, 1e-12);
  ASSERT_EQ(request.landmarks.size(), request.frame->features.size());
  const SyntheticView view = world_.Observe(2);
  int found = 0;
  for (size_t i = 0; i < request.landmarks.size(); ++i) {
    if (request.landmarks[i].IsValid()) {
      ++found;
      ASSERT_LT(i, view.points.size()) << "the added points are not in the map";
      EXPECT_EQ(request.landmarks[i], made_.landmarks[view.points[i]]);
    }
  }
  EXPECT_EQ(found, second.report.tracked.inliers);
  int sum = 0;
  for (const Sighting& sighting : request.sightings) {
    EXPECT_LE(sighting.found, sighting.visible);
    EXPECT_LE(sighting.visible, 2) << "two frames since the first keyframe";
    sum += sighting.found;
  }
  EXPECT_EQ(sum, first.report.tracked.inliers + second.report.tracked.inliers);
  const Tracker::Result third = Process(DemandingFrame(3));
  ASSERT_TRUE(third.message);
  for (const Sighting& sighting : RequestOf(third)->sightings) {
    EXPECT_LE(sighting.visible, 1);
  }
}

// The mapper forgets replacements that are older than the oldest snapshot that requests refer to.
TEST_F(TrackerTest, ARequestNamesTheOldestSnapshotOfItsIds) {
  Begin();
  const uint32_t oldest = map_->revision();
  EXPECT_FALSE(Process(world_.Observe(1).frame).message);
  map_ = Publish(made_.map);
  ASSERT_GT(map_->revision(), oldest);
  const Tracker::Result second = Process(DemandingFrame(2));
  ASSERT_TRUE(second.message);
  EXPECT_EQ(RequestOf(second)->oldest_revision, oldest) << "it has sightings of the first map";
  const uint32_t newest = map_->revision();
  const Tracker::Result third = Process(DemandingFrame(3));
  ASSERT_TRUE(third.message);
  EXPECT_EQ(RequestOf(third)->oldest_revision, newest);
}

// Others may need replacements of older ids, for example frames that are remembered.
TEST_F(TrackerTest, ARequestNamesTheOldestRevisionThatOthersNeed) {
  Begin();
  const uint32_t oldest = map_->revision();
  tracker_.KeepIdsSince(oldest);
  for (uint32_t i = 1; i < 4; ++i) {
    map_ = Publish(made_.map);
    const Tracker::Result result = Process(DemandingFrame(i));
    ASSERT_TRUE(result.message);
    EXPECT_EQ(RequestOf(result)->oldest_revision, oldest);
    EXPECT_EQ(result.report.map_revision, map_->revision());
  }
  tracker_.KeepIdsSince(map_->revision() + 5);
  map_ = Publish(made_.map);
  const Tracker::Result result = Process(DemandingFrame(4));
  ASSERT_TRUE(result.message);
  EXPECT_EQ(RequestOf(result)->oldest_revision, map_->revision());
}

TEST(Tracker, SameFramesGiveTheSameBits) {
  const SyntheticWorld world({.points = 400, .pixel_noise = 0.5, .flipped_bits = 10});
  SyntheticMap made = MakeSyntheticMap(world, {0, 8, 16});
  const auto map = Publish(made.map);
  const auto run = [&] {
    Tracker tracker(world.sensor(), TrackingOptions());
    std::vector<TrackedFrame> frames;
    for (uint32_t i = 0; i < 25; ++i) {
      frames.push_back(
          tracker.Process(world.Observe(i).frame, i == 0 ? nullptr : map, kIdle).report.tracked);
    }
    return frames;
  };
  const std::vector<TrackedFrame> a = run();
  const std::vector<TrackedFrame> b = run();
  for (size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].state, TrackingState::kTracked);
    ASSERT_EQ(a[i].from_keyframe.has_value(), b[i].from_keyframe.has_value());
    EXPECT_EQ(a[i].inliers, b[i].inliers);
    EXPECT_EQ(a[i].cam_from_world.rotation.coeffs(), b[i].cam_from_world.rotation.coeffs());
    EXPECT_EQ(a[i].cam_from_world.translation, b[i].cam_from_world.translation);
    if (a[i].from_keyframe) {
      EXPECT_EQ(a[i].from_keyframe->reference, b[i].from_keyframe->reference);
      EXPECT_EQ(a[i].from_keyframe->cam_from_reference.translation,
                b[i].from_keyframe->cam_from_reference.translation);
    }
  }
}

TEST_P(TrackerWith, NoiseMovesThePoseByLittle) {
  const SyntheticWorld world({.points = 400, .pixel_noise = 0.5, .flipped_bits = 10},
                             world_.sensor());
  SyntheticMap made = MakeSyntheticMap(world, {0, 8, 16});
  const auto map = Publish(made.map);
  Tracker tracker(world.sensor(), TrackingOptions());
  tracker.Process(world.Observe(0).frame, nullptr, kIdle);
  for (uint32_t i = 1; i < 25; ++i) {
    const Tracker::Result result = tracker.Process(world.Observe(i).frame, map, kIdle);
    ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked);
    ExpectNear(result.report.tracked.cam_from_world, SyntheticWorld::CamFromWorld(i), 1e-2);
  }
}

// Keyframes are at least 0.2 s apart, whatever the frame rate is.
TEST_F(TrackerTest, TheIntervalOfKeyframesIsATime) {
  options_.keyframe_interval = 0.2;
  for (const uint32_t rate : {10U, 30U}) {
    Tracker tracker(world_.sensor(), options_);
    tracker.Process(world_.Observe(0).frame, nullptr, kIdle);
    const auto map = Publish(made_.map);
    uint32_t first_request = 0;
    for (uint32_t i = 1; i <= 10 && first_request == 0; ++i) {
      auto frame = std::make_shared<Frame>(*DemandingFrame(i));
      frame->timestamp = static_cast<double>(i) / rate;
      first_request = tracker.Process(frame, map, kIdle).message ? i : 0;
    }
    EXPECT_EQ(first_request, rate / 5);
  }
}

// The camera turns by 4 degrees in 1/30 s, which moves keypoints by 35 px.
TEST_F(TrackerTest, TheMotionModelCountsTheTimeBetweenFrames) {
  const Rigid3 turn(ExpSo3({0.0, 0.07, 0.0}), Eigen::Vector3d::Zero());
  const SyntheticView view = world_.Observe(FrameId(1), turn);
  LastFrame last;
  last.frame = view.frame;
  for (const uint32_t point : view.points) {
    last.landmarks.push_back(made_.landmarks[point]);
  }
  last.reference = KeyframeId(0);
  last.cam_from_world = turn;
  last.motion = CameraMotion{turn, 1.0 / 30.0};
  const auto found = [&](double time_step) {
    Frame next = *world_.Observe(FrameId(2), turn * turn * turn * turn).frame;
    next.timestamp = last.frame->timestamp + time_step;
    const auto estimate = PoseByMotionModel(
        next, made_.map, {world_.sensor(), options_, ObjectOptions(), ObjectIndex()}, last);
    return estimate ? estimate->inliers : 0;
  };
  EXPECT_GT(found(3.0 / 30.0), 50);
  EXPECT_LT(found(1.0 / 30.0), 0.75 * found(3.0 / 30.0));
}

// The share of the visible landmarks that the motion model finds if the camera turns by the first
// angle where the second one is expected (radians).
class MotionModelTest : public TrackerTest {
 protected:
  double FoundShare(int width, double turned, double expected, bool is_wide = true) const {
    const Rigid3 turn(ExpSo3({0.0, expected, 0.0}), Eigen::Vector3d::Zero());
    const SyntheticView view = world_.Observe(FrameId(1), Rigid3());
    LastFrame last;
    last.frame = view.frame;
    for (const uint32_t point : view.points) {
      last.landmarks.push_back(made_.landmarks[point]);
    }
    last.reference = KeyframeId(0);
    last.motion = CameraMotion{turn, 1.0 / 30.0};
    const Rigid3 pose(ExpSo3({0.0, turned, 0.0}), Eigen::Vector3d::Zero());
    Frame next = *world_.Observe(FrameId(2), pose).frame;
    next.timestamp = last.frame->timestamp + 1.0 / 30.0;
    Sensor sensor = world_.sensor();
    sensor.camera.width = width;
    TrackingOptions options = options_;
    options.wide_search = is_wide;
    const auto estimate =
        PoseByMotionModel(next, made_.map, {sensor, options, ObjectOptions(), ObjectIndex()}, last);
    return estimate ? estimate->inliers / static_cast<double>(next.features.size()) : 0.0;
  }
};

// A slow camera that turns by 5 degrees (44 px) is missed with the windows of a usual image. In one
// that is three times as wide, 44 px are a third of the angle.
TEST_F(MotionModelTest, TheWindowGrowsWithTheImage) {
  EXPECT_LT(FoundShare(640, 0.087, 0.0), 0.6);
  EXPECT_GT(FoundShare(1920, 0.087, 0.0), 0.8);
}

// The camera has turned by 16 degrees (140 px) from frame to frame and stops.
TEST_F(MotionModelTest, TheWindowGrowsWithTheMotion) {
  EXPECT_GT(FoundShare(640, 0.0, 0.28), 0.1);
  EXPECT_EQ(FoundShare(640, 0.28, 0.0), 0.0) << "no motion was seen before";
}

TEST_F(MotionModelTest, UnlessItIsWideTheWindowDoublesOnce) {
  EXPECT_EQ(FoundShare(1920, 0.087, 0.0, false), FoundShare(640, 0.087, 0.0, false));
  EXPECT_EQ(FoundShare(640, 0.0, 0.28, false), 0.0);
}

TEST_F(TrackerTest, SaysWhyAFrameIsLost) {
  const SyntheticWorld other({.points = 300, .seed = 77});
  const size_t enough = static_cast<size_t>(options_.min_inliers);
  auto late = std::make_shared<Frame>(*other.Observe(5).frame);
  late->timestamp += 1.0;
  const std::vector<std::pair<std::shared_ptr<const Frame>, TrackingFailure>> frames = {
      {Select(*world_.Observe(5).frame, {}), TrackingFailure::kTooFewFeatures},
      {FrameWithKnown(5, enough - 1), TrackingFailure::kTooFewLandmarks},
      {other.Observe(5).frame, TrackingFailure::kNotRecognised},
      {late, TrackingFailure::kImagesMissing}};
  for (const auto& [frame, reason] : frames) {
    Tracker tracker(world_.sensor(), options_);
    tracker.Process(world_.Observe(0).frame, nullptr, kIdle);
    const auto map = Publish(made_.map);
    for (uint32_t i = 1; i < 5; ++i) {
      EXPECT_FALSE(tracker.Process(world_.Observe(i).frame, map, kIdle).report.loss);
    }
    const Tracker::Result lost = tracker.Process(frame, map, kIdle);
    EXPECT_EQ(lost.report.tracked.state, TrackingState::kLost) << ToString(reason);
    EXPECT_EQ(lost.report.loss, reason) << ToString(reason);
  }
}

// The synthetic world with six balls, which all keyframes and frames detect.
class ObjectTrackerTest : public TrackerTest {
 protected:
  ObjectTrackerTest() {
    made_ = MakeSyntheticMap(world_, {0, 5, 10}, [this](Frame& frame, const Rigid3& camera) {
      AddDetections(frame, camera);
    });
    for (uint32_t k = 0; k < balls_.size(); ++k) {
      const ObjectId id = made_.map.AddObject();
      for (uint32_t keyframe = 0; keyframe < 3; ++keyframe) {
        EXPECT_TRUE(made_.map.AddObservation(id, KeyframeId(keyframe), k));
      }
      ObjectLandmark& object = made_.map.MutableObject(id);
      object.state = ObjectState::kMapped;
      object.has_shape = true;
      object.ellipsoid = balls_[k].ellipsoid;
      object.misfit_px = 1.0;
    }
  }
  void AddDetections(Frame& frame, const Rigid3& cam_from_world) const {
    for (const MadeObject& ball : balls_) {
      frame.detections.push_back(Detect(ball, world_.sensor(), cam_from_world));
    }
  }
  std::shared_ptr<const Frame> WithDetections(const Frame& frame) const {
    auto changed = std::make_shared<Frame>(frame);
    AddDetections(*changed, SyntheticWorld::CamFromWorld(frame.id.value));
    return changed;
  }
  // A frame that shows no landmark, but all balls and many new close points.
  std::shared_ptr<const Frame> FrameWithoutLandmarks(uint32_t index) const {
    auto frame = Select(*world_.Observe(index).frame, {});
    AddUnknownPoints(world_.sensor(), 200, 0, *frame);
    return WithDetections(*frame);
  }

  const std::vector<MadeObject> balls_ = {MakeObject("ball", {-1.0, -0.6, 4.0}, {0.25, 0.25, 0.25}),
                                          MakeObject("ball", {0.0, -0.6, 4.0}, {0.25, 0.25, 0.25}),
                                          MakeObject("ball", {1.0, -0.6, 4.0}, {0.25, 0.25, 0.25}),
                                          MakeObject("ball", {-1.0, 0.6, 4.0}, {0.25, 0.25, 0.25}),
                                          MakeObject("ball", {0.0, 0.6, 4.0}, {0.25, 0.25, 0.25}),
                                          MakeObject("ball", {1.0, 0.6, 4.0}, {0.25, 0.25, 0.25})};
};

// Such a keyframe would have no edge to the others, and its new landmarks would be second copies of
// landmarks of the map.
TEST_F(ObjectTrackerTest, AFrameThatOnlyObjectsLocateIsNoKeyframe) {
  Begin();
  for (uint32_t i = 1; i <= 2; ++i) {
    Process(WithDetections(*world_.Observe(i).frame));
  }
  const Tracker::Result result = Process(FrameWithoutLandmarks(3));
  EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked);
  EXPECT_EQ(result.report.tracked.inliers, 0);
  ExpectNear(result.report.tracked.cam_from_world, SyntheticWorld::CamFromWorld(3), 1e-2);
  EXPECT_FALSE(result.message);
}

TEST_F(ObjectTrackerTest, FindsLandmarksAgainAfterAFrameWithoutThem) {
  Begin();
  for (uint32_t i = 1; i <= 2; ++i) {
    Process(WithDetections(*world_.Observe(i).frame));
  }
  Process(FrameWithoutLandmarks(3));
  const Tracker::Result result = Process(WithDetections(*world_.Observe(4).frame));
  EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked);
  EXPECT_GT(result.report.tracked.inliers, 100);
  ExpectNear(result.report.tracked.cam_from_world, SyntheticWorld::CamFromWorld(4), 1e-3);
}

// ---- a map of an earlier session

TEST_F(TrackerTest, WithAMapAndWithoutWordsItStaysLost) {
  map_ = Publish(made_.map);
  for (uint32_t i = 0; i < 3; ++i) {
    const Tracker::Result result = Process(DemandingFrame(i));
    EXPECT_EQ(result.report.tracked.state, TrackingState::kLost);
    EXPECT_FALSE(result.message);
  }
}

// The map of an earlier session shows two thirds of the ring world. The tracker has seen nothing.
class TrackerWithMap : public testing::Test {
 protected:
  TrackerWithMap() : map_(Publish(made_.map)) {}

  // A frame with unknown close points, and with few keypoints that show landmarks, so that it
  // needs a keyframe. It is the frame after `turns` turns.
  std::shared_ptr<Frame> DemandingFrame(uint32_t id, double turns) const {
    constexpr uint32_t kKnown = 150;
    const SyntheticView view = world_.Observe(FrameId(id), RingWorld::CamFromWorld(turns));
    std::vector<uint32_t> keypoints = AllKeypoints(*view.frame);
    keypoints.resize(std::min<size_t>(keypoints.size(), kKnown));
    auto frame = Select(*view.frame, keypoints);
    AddUnknownPoints(world_.sensor(), 80, 0, *frame);
    frame->words = world_.vocabulary()->WordsOf(frame->features.descriptors);
    return frame;
  }
  Tracker::Result Process(std::shared_ptr<const Frame> frame) {
    return tracker_.Process(std::move(frame), map_, kIdle);
  }

  const RingWorld& world_ = SharedRing();
  RingMap made_ = MakeRingMap(world_, {.keyframes = 16, .drift = Rigid3()});
  const std::shared_ptr<const Map> map_;
  Tracker tracker_{world_.sensor(), TrackingOptions()};
};

TEST_F(TrackerWithMap, IsLostUntilItSeesAPlaceOfTheMap) {
  constexpr double kUnknownPlace = 0.82;  // turns
  uint32_t first_request = 0;
  for (uint32_t i = 10; i < 25; ++i) {
    const bool is_known = i >= 12;
    const double turns = is_known ? 0.25 + 0.002 * i : kUnknownPlace;
    const std::shared_ptr<Frame> frame = DemandingFrame(i, turns);
    if (i > 12) {
      frame->words = {};  // the last frame leads to this one
    }
    const Tracker::Result result = Process(frame);
    EXPECT_EQ(result.report.tracked.state,
              is_known ? TrackingState::kTracked : TrackingState::kLost)
        << i;
    EXPECT_FALSE(result.message && !is_known);
    if (is_known) {
      ExpectNear(result.report.tracked.cam_from_world, RingWorld::CamFromWorld(turns), 0.005);
    }
    if (first_request == 0 && RequestOf(result) != nullptr) {
      first_request = i;
    }
  }
  EXPECT_EQ(first_request, 18u) << "0.2 s after the first pose";
}

TEST_F(TrackerWithMap, LocalizationRequestsNoKeyframes) {
  tracker_.LocaliseOnly();
  for (uint32_t i = 0; i < 60; ++i) {
    const Tracker::Result result = Process(DemandingFrame(i, 0.25 + 0.002 * i));
    EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked) << i;
    EXPECT_FALSE(result.message);
  }
}

// A map of two thirds of the ring world. The camera stands at its beginning.
class RelocalisingTracker : public testing::Test {
 protected:
  RelocalisingTracker() {
    tracker_.Process(Look(0, 0.0), nullptr, kIdle);
    for (uint32_t i = 1; i <= 3; ++i) {
      EXPECT_EQ(Process(Look(1000 + i, 0.0)).state, TrackingState::kTracked);
    }
  }
  std::shared_ptr<Frame> Look(uint32_t id, double turns) const {
    return std::make_shared<Frame>(
        *world_.Observe(FrameId(id), RingWorld::CamFromWorld(turns)).frame);
  }
  TrackedFrame Process(std::shared_ptr<const Frame> frame) {
    return tracker_.Process(std::move(frame), map_, kIdle).report.tracked;
  }
  void LoseTrack() {
    auto blank = std::make_shared<Frame>();
    blank->id = FrameId(1004);
    blank->timestamp = 1004 / world_.sensor().frames_per_second;
    RebuildGrid(world_.sensor(), *blank);
    EXPECT_EQ(Process(blank).state, TrackingState::kLost);
  }

  const RingWorld& world_ = SharedRing();
  RingMap made_ = MakeRingMap(world_, {.keyframes = 16, .drift = Rigid3()});
  const std::shared_ptr<const Map> map_ = Publish(made_.map);
  Tracker tracker_{world_.sensor(), TrackingOptions(), ObjectOptions(), 1};
};

TEST_F(RelocalisingTracker, ContinuesAtAnotherPlaceOfTheMap) {
  LoseTrack();
  for (uint32_t i = 0; i < 4; ++i) {
    const double turns = 0.45 + 0.005 * i;
    const TrackedFrame tracked = Process(Look(1010 + i, turns));
    ASSERT_EQ(tracked.state, TrackingState::kTracked) << i;
    ExpectNear(tracked.cam_from_world, RingWorld::CamFromWorld(turns), 0.005);
    EXPECT_GT(tracked.from_keyframe->reference, KeyframeId(8)) << "a keyframe of the new place";
  }
}

TEST_F(RelocalisingTracker, StaysLostAtAPlaceThatTheMapLacks) {
  LoseTrack();
  EXPECT_EQ(Process(Look(1010, 0.82)).state, TrackingState::kLost);
  EXPECT_EQ(Process(Look(1011, 0.3)).state, TrackingState::kTracked);
}

// Such a frame becomes a keyframe, and as long as each does, images are far apart.
TEST_F(RelocalisingTracker, IsFoundElsewhereWithoutWordsByAllDescriptors) {
  LoseTrack();
  EXPECT_FALSE(tracker_.HasWideSteps());
  const auto frame = Look(1010, 0.45);
  frame->words = {};
  const Tracker::Result result = tracker_.Process(frame, map_, kIdle);
  ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked);
  ExpectNear(result.report.tracked.cam_from_world, RingWorld::CamFromWorld(0.45), 0.01);
  EXPECT_NE(RequestOf(result), nullptr);
  EXPECT_TRUE(tracker_.HasWideSteps());
  const auto next = Look(1011, 0.451);
  EXPECT_FALSE(tracker_.Process(next, map_, kIdle).message);
  EXPECT_FALSE(tracker_.HasWideSteps());
}

TEST_F(RelocalisingTracker, IsFoundElsewhereByAllDescriptorsWithoutDepthToo) {
  Sensor monocular = world_.sensor();
  monocular.kind = SensorKind::kMonocular;
  Tracker tracker(monocular, TrackingOptions(), ObjectOptions(), 1);
  ASSERT_EQ(tracker.Process(Look(1000, 0.2), map_, kIdle).report.tracked.state,
            TrackingState::kTracked);
  const auto frame = Look(1010, 0.45);
  frame->words = {};
  const Tracker::Result result = tracker.Process(frame, map_, kIdle);
  ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked);
  ExpectNear(result.report.tracked.cam_from_world, RingWorld::CamFromWorld(0.45), 0.01);
  EXPECT_TRUE(tracker.HasWideSteps());
}

TEST_F(RelocalisingTracker, StaysLostElsewhereWithoutWordsIfItMayNotMatchWidely) {
  TrackingOptions options;
  options.wide_matches = false;
  Tracker tracker(world_.sensor(), options, ObjectOptions(), 1);
  tracker.Process(Look(0, 0.0), nullptr, kIdle);
  const auto frame = Look(1010, 0.45);
  frame->words = {};
  EXPECT_EQ(tracker.Process(frame, map_, kIdle).report.tracked.state, TrackingState::kLost);
  EXPECT_FALSE(tracker.HasHadWideSteps());
}

// Three times as many landmarks are needed where the place may only look like another one.
TEST_F(RelocalisingTracker, StaysLostWithoutWordsIfItFindsFewLandmarks) {
  LoseTrack();
  const auto whole = Look(1010, 0.45);
  std::vector<uint32_t> some = AllKeypoints(*whole);
  some.resize(80);
  const auto frame = Select(*whole, some);
  RebuildGrid(world_.sensor(), *frame);
  EXPECT_EQ(Process(frame).state, TrackingState::kLost);
}

// The frame is of another place, but some keypoints look as if the camera had not moved: enough
// for a first pose, too few for the local map.
TEST_F(RelocalisingTracker, TriesTheNextSourceIfTheLocalMapDoesNotConfirmAPose) {
  constexpr size_t kMisleading = 25;
  const auto frame = Look(1004, 0.45);
  const auto still = Look(1004, 0.0);
  const std::vector<LandmarkId>& known = made_.map.keyframes().At(KeyframeId(0)).landmarks;
  std::vector<WordId> words = frame->words.get();
  size_t added = 0;
  for (size_t i = 0; i < known.size() && added < kMisleading; ++i) {
    if (known[i].IsValid()) {
      frame->features.keypoints.push_back(still->features.keypoints[i]);
      frame->features.descriptors.push_back(still->features.descriptors[i]);
      frame->features.depth.push_back(still->features.depth[i]);
      words.push_back(still->words.get()[i]);
      ++added;
    }
  }
  frame->words = std::move(words);
  ASSERT_EQ(added, kMisleading);
  RebuildGrid(world_.sensor(), *frame);
  const TrackedFrame tracked = Process(frame);
  ASSERT_EQ(tracked.state, TrackingState::kTracked);
  ExpectNear(tracked.cam_from_world, RingWorld::CamFromWorld(0.45), 0.005);
}

// The errors of tracking with a camera that has a rolling shutter.
struct ShutterErrors {
  double pose = 0.0;   // m, the largest distance from the true position
  double pixel = 0.0;  // px, the largest one in the frames that the tracker hands on
};

// `known`: whether the tracker is told of the shutter.
ShutterErrors TrackWithRollingShutter(const SyntheticWorldOptions& options, bool known) {
  const SyntheticWorld world(options);
  Sensor sensor = world.sensor();
  sensor.readout_time = known ? options.readout_time : 0.0;
  SyntheticMap made = MakeSyntheticMap(world, {0, 15, 30});
  Tracker tracker(sensor, {});
  const std::shared_ptr<const Map> map = Publish(made.map);
  tracker.Process(world.Observe(0).frame, nullptr, kIdle);
  ShutterErrors errors;
  for (uint32_t i = 1; i < 25; ++i) {
    const SyntheticView view = world.Observe(i);
    const Tracker::Result result = tracker.Process(view.frame, map, kIdle);
    EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked) << i;
    if (i < 10) {
      continue;  // the first velocities were measured with frames that were not corrected
    }
    const Rigid3 truth = SyntheticWorld::CamFromWorld(i);
    errors.pose = std::max(
        errors.pose, (result.report.tracked.cam_from_world.translation - truth.translation).norm());
    for (size_t k = 0; k < view.points.size(); ++k) {
      const Eigen::Vector2d pixel = sensor.camera.Project(truth * world.points()[view.points[k]]);
      const auto& seen = result.report.frame->features.keypoints[k].undistorted;
      errors.pixel = std::max(errors.pixel, (pixel - seen.cast<double>()).norm());
    }
  }
  return errors;
}

TEST(Tracker, RemovesTheEffectOfARollingShutter) {
  for (const ReadoutDirection direction : {ReadoutDirection::kRows, ReadoutDirection::kColumns}) {
    for (const double readout_time : {0.03, -0.03}) {
      const SyntheticWorldOptions options{
          .points = 300, .readout_time = readout_time, .readout_direction = direction};
      const ShutterErrors ignored = TrackWithRollingShutter(options, false);
      const ShutterErrors corrected = TrackWithRollingShutter(options, true);
      EXPECT_GT(ignored.pixel, 0.6);
      EXPECT_LT(corrected.pixel, 0.2 * ignored.pixel);
      EXPECT_LT(corrected.pose, 0.2 * ignored.pose);
    }
  }
}

// A camera with a rolling shutter in a known map.
class RollingTracker : public testing::Test {
 protected:
  static constexpr double kInterval = 1.0 / 30.0;

  // Image `number` of a world, taken at a place of the path. The map has other numbers, but for 0.
  static std::shared_ptr<Frame> Image(const SyntheticWorld& world, uint32_t number, uint32_t place,
                                      double timestamp) {
    auto frame = std::make_shared<Frame>(*world.Observe(place).frame);
    frame->id = FrameId(number);
    frame->timestamp = timestamp;
    return frame;
  }
  // Tracks 30 images and returns the root mean square of the errors of the positions, m.
  // `place` and `stamp` are those of image i; `known` is the readout time that the tracker knows.
  double ErrorOf(double known, const std::function<uint32_t(uint32_t)>& place,
                 const std::function<double(uint32_t)>& stamp) {
    Sensor sensor = world_.sensor();
    sensor.readout_time = known;
    Tracker tracker(sensor, {});
    tracker.Process(Image(world_, 0, place(0), stamp(0)), nullptr, kIdle);
    const std::shared_ptr<const Map> map = Publish(made_.map);
    double sum = 0.0;
    for (uint32_t i = 1; i <= 30; ++i) {
      const TrackedFrame tracked =
          tracker.Process(Image(world_, 1000 + i, place(i), stamp(i)), map, kIdle).report.tracked;
      EXPECT_EQ(tracked.state, TrackingState::kTracked) << i;
      sum += (Inverse(tracked.cam_from_world).translation -
              Inverse(SyntheticWorld::CamFromWorld(place(i))).translation)
                 .squaredNorm();
    }
    return std::sqrt(sum / 30.0);
  }
  static uint32_t Steady(uint32_t i) { return i; }
  static double Even(uint32_t i) { return i * kInterval; }

  const SyntheticWorld world_{{.points = 300, .readout_time = 0.026}};
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 15, 30, 45, 60});
};

TEST_F(RollingTracker, StampsThatComeInPairsDoNoHarm) {
  const double ignored = ErrorOf(0.0, &Steady, &Even);
  for (const double apart : {2e-6, 0.001, 0.005, 0.015}) {
    const auto stamp = [&](uint32_t i) { return i % 2 == 0 ? Even(i) : Even(i + 1) - apart; };
    EXPECT_LT(ErrorOf(0.026, &Steady, stamp), 1.05 * ignored) << apart;
  }
}

// The stamps do not show that 30 images are missing.
TEST_F(RollingTracker, AnUnseenGapDoesNoHarm) {
  const auto place = [](uint32_t i) { return i < 15 ? i : i + 30; };
  EXPECT_LT(ErrorOf(0.026, place, &Even), 1.05 * ErrorOf(0.0, place, &Even));
}

// The camera jumps ahead after it has shown one image for a while.
TEST_F(RollingTracker, AnImageThatComesAgainDoesNoHarm) {
  const auto place = [](uint32_t i) { return i / 25 * 25; };
  EXPECT_LT(ErrorOf(0.026, place, &Even), 1.05 * ErrorOf(0.0, place, &Even));
}

// The shutter of this camera is a global one, so a correction moves keypoints away from where they
// should be: 50 px from image to image would be up to 20 px during the readout.
TEST_F(RollingTracker, ACorrectionThatFitsWorseIsNotKept) {
  const SyntheticWorld world({.points = 300});
  SyntheticMap made = MakeSyntheticMap(world, {0, 20, 40, 60, 80, 100, 120, 140, 160, 180});
  const std::shared_ptr<const Map> map = Publish(made.map);
  Tracker tracker(world_.sensor(), {});
  tracker.Process(Image(world, 0, 0, 0.0), nullptr, kIdle);
  for (uint32_t i = 1; i <= 10; ++i) {
    const auto frame = Image(world, 1000 + i, 20 * i, Even(i));
    const Tracker::Result result = tracker.Process(frame, map, kIdle);
    EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked);
    EXPECT_EQ(result.report.frame, frame) << i;
    ExpectNear(result.report.tracked.cam_from_world, SyntheticWorld::CamFromWorld(20 * i), 1e-3);
  }
}

// A quick turn stops at once. What the last velocity predicts is no more than a guess.
TEST_F(RollingTracker, AVelocityThatEndsDoesNotLoseTheCamera) {
  const auto map = Publish(made_.map);
  const Sensor& sensor = world_.sensor();
  Tracker tracker(sensor, {});
  // The pose at a place `turn` radians to the side.
  const auto at = [](double turn) {
    return Rigid3(ExpSo3(Eigen::Vector3d(0.0, turn, 0.0)), Eigen::Vector3d::Zero()) *
           SyntheticWorld::CamFromWorld(0);
  };
  tracker.Process(world_.Observe(FrameId(0), at(0.0)).frame, nullptr, kIdle);
  for (uint32_t i = 1; i <= 8; ++i) {
    const double turn = i < 3 ? 0.0 : i == 3 ? 0.2 : 0.4;
    const Tracker::Result result =
        tracker.Process(world_.Observe(FrameId(i), at(turn)).frame, map, kIdle);
    ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked) << i;
  }
}

// Frames without depth of a moving camera, before there is a map.
class MonocularTracker : public testing::Test {
 protected:
  static Sensor WithoutDepth(Sensor sensor) {
    sensor.kind = SensorKind::kMonocular;
    return sensor;
  }
  // Gives frames to the tracker until it sends a map; returns the number of the last one.
  uint32_t WaitForMap() {
    for (uint32_t i = 0; i < 40; ++i) {
      const Tracker::Result result = tracker_.Process(world_.Observe(i).frame, nullptr, kIdle);
      EXPECT_EQ(result.report.failure.has_value(), !result.message.has_value());
      if (result.message) {
        EXPECT_TRUE(std::holds_alternative<InitialMap>(*result.message));
        EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked);
        return i;
      }
      EXPECT_EQ(result.report.tracked.state, TrackingState::kNotInitialized);
    }
    ADD_FAILURE() << "there is no map";
    return 0;
  }

  explicit MonocularTracker(const TrackingOptions& options = {}) : options_(options) {}

  const SyntheticWorld world_{{.points = 300, .depth_share = 0.0}};
  const Sensor sensor_ = WithoutDepth(world_.sensor());
  TrackingOptions options_;
  Tracker tracker_{sensor_, options_};
};

TEST_F(MonocularTracker, WaitsForAMapAndGivesTheFirstFramesPosesAtTheEnd) {
  const uint32_t last = WaitForMap();
  ASSERT_GT(last, 4U);
  const SyntheticMap made = MakeSyntheticMap(world_, {2, last / 2, last});
  const std::vector<TrackedFrame> early = tracker_.LocaliseEarlyFrames(made.map);
  ASSERT_EQ(early.size(), last);
  for (uint32_t i = 0; i < last; ++i) {
    EXPECT_EQ(early[i].frame, FrameId(i));
    EXPECT_EQ(early[i].state, TrackingState::kTracked);
    if (i == 2 || i == last / 2) {
      EXPECT_FALSE(early[i].from_keyframe) << "it is a keyframe";
    } else {
      ASSERT_TRUE(early[i].from_keyframe) << i;
      const Rigid3 truth = SyntheticWorld::CamFromWorld(i);
      EXPECT_LT(
          (made.map.CamFromWorld(*early[i].from_keyframe).translation - truth.translation).norm(),
          0.02);
    }
  }
  EXPECT_TRUE(tracker_.LocaliseEarlyFrames(made.map).empty());
}

TEST_F(MonocularTracker, TheFirstFramesStayWithoutPosesIfTheyAreNotWanted) {
  options_.locate_at_end = false;
  Tracker tracker(sensor_, options_);
  uint32_t last = 0;
  while (last < 40 && !tracker.Process(world_.Observe(last).frame, nullptr, kIdle).message) {
    ++last;
  }
  ASSERT_LT(last, 40u);
  const SyntheticMap made = MakeSyntheticMap(world_, {2, last / 2, last});
  EXPECT_TRUE(tracker.LocaliseEarlyFrames(made.map).empty());
}

TEST_F(MonocularTracker, FramesThatTheMapDoesNotShowAreLeftOut) {
  const uint32_t last = WaitForMap();
  const SyntheticWorld other({.points = 300, .depth_share = 0.0, .seed = 77});
  const SyntheticMap made = MakeSyntheticMap(other, {last + 10, last + 20});
  EXPECT_TRUE(tracker_.LocaliseEarlyFrames(made.map).empty());
}

// A monocular camera that has a young map of one world and is then in another one.
class LostMonocularTracker : public MonocularTracker {
 protected:
  // A frame of a world with the id `number`, seen from the pose `index` of its path.
  static std::shared_ptr<const Frame> FrameOf(const SyntheticWorld& world, uint32_t number,
                                              uint32_t index) {
    auto frame = std::make_shared<Frame>(*world.Observe(index).frame);
    frame->id = FrameId(number);
    frame->timestamp = number / world.sensor().frames_per_second;
    return frame;
  }
  // Begins with a map of the given number of keyframes. Then tracking is lost from frame 100 on,
  // for the given number of frames. Returns the frame that begins an island; 0 if there is none.
  uint32_t BeginAndLose(uint32_t keyframes, uint32_t frames) {
    const uint32_t last = WaitForMap();
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < keyframes; ++i) {
      indices.push_back(last + 2 * i);
    }
    made_ = MakeSyntheticMap(world_, indices);
    map_ = Publish(made_.map);
    EXPECT_EQ(Process(world_.Observe(last + 1).frame).report.tracked.state,
              TrackingState::kTracked);
    for (uint32_t i = 100; i < 100 + frames; ++i) {
      const Tracker::Result result = Process(FrameOf(other_, i, i - 100));
      EXPECT_FALSE(result.report.failure) << "there is a map";
      if (result.message) {
        EXPECT_TRUE(std::holds_alternative<InitialMap>(*result.message));
        EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked);
        EXPECT_FALSE(result.report.tracked.from_keyframe) << "it is a keyframe";
        island_ = std::get<InitialMap>(*result.message);
        return i;
      }
      EXPECT_EQ(result.report.tracked.state, TrackingState::kLost);
    }
    return 0;
  }
  Tracker::Result Process(std::shared_ptr<const Frame> frame) {
    return tracker_.Process(std::move(frame), map_, kIdle);
  }
  explicit LostMonocularTracker(const TrackingOptions& options = {}) : MonocularTracker(options) {}

  const SyntheticWorld other_{{.points = 300, .depth_share = 0.0, .seed = 77}};
  SyntheticMap made_;
  std::shared_ptr<const Map> map_;
  InitialMap island_;
};

// A map of three keyframes, in which every third landmark is observed by only two of them. The next
// frame shows few landmarks.
class WeakMonocularTracker : public LostMonocularTracker {
 protected:
  WeakMonocularTracker() {
    last_ = WaitForMap();
    made_ = MakeSyntheticMap(world_, {last_, last_ + 2, last_ + 4});
    for (size_t point = 0; point < made_.landmarks.size(); point += 3) {
      if (made_.landmarks[point].IsValid()) {
        made_.landmarks[point] = ObserveByTwo(made_.landmarks[point]);
      }
    }
    map_ = Publish(made_.map);
  }
  // The landmark again, as its two first keyframes would make it.
  LandmarkId ObserveByTwo(LandmarkId id) {
    const Landmark old = made_.map.landmarks().At(id);
    made_.map.EraseLandmark(id);
    const LandmarkId landmark = made_.map.AddLandmark(old.position, old.created_by);
    for (size_t i = 0; i < std::min<size_t>(2, old.observations.size()); ++i) {
      made_.map.AddObservation(landmark, old.observations[i].keyframe,
                               old.observations[i].keypoint);
    }
    UpdateDescriptor(made_.map, landmark);
    UpdateViewingGeometry(made_.map, landmark, sensor_.levels);
    return landmark;
  }
  // The result for the frame after the initial map, which shows so many landmarks of three
  // keyframes and of two.
  Tracker::Result TrackWith(size_t of_three, size_t of_two) {
    const SyntheticView view = world_.Observe(last_ + 1);
    std::vector<uint32_t> keypoints;
    for (uint32_t i = 0; i < view.points.size(); ++i) {
      const LandmarkId id = made_.landmarks[view.points[i]];
      const size_t observers = id.IsValid() ? made_.map.landmarks().At(id).observations.size() : 0;
      size_t* const left = observers == 3 ? &of_three : observers == 2 ? &of_two : nullptr;
      if (left != nullptr && *left > 0) {
        --*left;
        keypoints.push_back(i);
      }
    }
    EXPECT_EQ(of_three + of_two, 0u) << "there are too few";
    Tracker::Result result = Process(Select(*view.frame, keypoints));
    EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked);
    EXPECT_EQ(result.report.tracked.inliers, static_cast<int>(keypoints.size()));
    return result;
  }

  uint32_t last_ = 0;
};

TEST_F(WeakMonocularTracker, IsUnsureOfAPoseThatNeedsLandmarksOfTwoKeyframes) {
  const Tracker::Result result = TrackWith(29, 36);
  EXPECT_TRUE(result.report.tracked.is_unsure);
  EXPECT_EQ(RequestOf(result), nullptr) << "no keyframe may rest on such a pose before its time";
}

TEST_F(WeakMonocularTracker, AsksForAKeyframeAtOnceWhereThePoseIsSure) {
  const Tracker::Result result = TrackWith(30, 35);
  EXPECT_FALSE(result.report.tracked.is_unsure);
  EXPECT_NE(RequestOf(result), nullptr);
}

TEST_F(LostMonocularTracker, BeginsAnIslandAndFollowsIt) {
  const uint32_t begin = BeginAndLose(3, 40);
  ASSERT_GT(begin, 100u);
  EXPECT_EQ(island_.views.back().frame->id, FrameId(begin));
  EXPECT_GE(island_.views.front().frame->id, FrameId(100)) << "only frames after tracking was lost";
  std::vector<LandmarkId> created;
  const std::vector<KeyframeId> ids = InsertInitialMap(made_.map, island_, sensor_, created);
  map_ = Publish(made_.map);
  for (uint32_t i = begin + 1; i < begin + 4; ++i) {
    const Tracker::Result result = Process(FrameOf(other_, i, i - 100));
    ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked);
    EXPECT_EQ(IslandOf(*map_, result.report.tracked.from_keyframe->reference), IslandId(1));
  }
}

TEST_F(LostMonocularTracker, TheFramesBeforeTheIslandGetPosesAtTheEnd) {
  const uint32_t begin = BeginAndLose(3, 40);
  ASSERT_GT(begin, 100u);
  std::vector<LandmarkId> created;
  InsertInitialMap(made_.map, island_, sensor_, created);
  ASSERT_TRUE(KeepOnlyIsland(made_.map, IslandId(1)));
  const std::vector<TrackedFrame> early = tracker_.LocaliseEarlyFrames(made_.map);
  ASSERT_GE(early.size(), begin - 100);
  for (const TrackedFrame& frame : early) {
    EXPECT_GE(frame.frame, FrameId(100)) << "the first island is not there any more";
  }
}

// The island stays young because nothing new is seen.
TEST_F(LostMonocularTracker, TheFirstFramesGetPosesAlthoughTheCameraThenStandsStill) {
  const uint32_t last = WaitForMap();
  made_ = MakeSyntheticMap(world_, {last, last + 2, last + 4});
  map_ = Publish(made_.map);
  for (uint32_t i = 0; i < 310; ++i) {
    ASSERT_EQ(Process(FrameOf(world_, 100 + i, last + 1)).report.tracked.state,
              TrackingState::kTracked);
  }
  const std::vector<TrackedFrame> early = tracker_.LocaliseEarlyFrames(made_.map);
  ASSERT_EQ(early.size(), 300u);
  for (uint32_t i = 0; i < last; ++i) {
    EXPECT_EQ(early[i].frame, FrameId(i));
  }
}

TEST_F(LostMonocularTracker, WithoutWordsAGrownMapIsNotGivenUp) {
  EXPECT_EQ(BeginAndLose(12, 60), 0u);
}

// As in ORB-SLAM2, which begins its map again if it is lost with at most five keyframes.
class OnlyTinyMapsAreGivenUp : public LostMonocularTracker {
 protected:
  OnlyTinyMapsAreGivenUp() : LostMonocularTracker({.begin_islands = false}) {}
};

TEST_F(OnlyTinyMapsAreGivenUp, WithFiveKeyframes) { EXPECT_GT(BeginAndLose(5, 40), 100u); }

TEST_F(OnlyTinyMapsAreGivenUp, NotWithSix) { EXPECT_EQ(BeginAndLose(6, 60), 0u); }

// A camera with depth that knows one world and is then in another one.
class LostDepthTracker : public TrackerTest {
 protected:
  // Is lost from frame `first` on until it begins an island; returns how long that took, s, or
  // nothing if it did not within 40 frames.
  std::optional<double> LoseUntilIsland(uint32_t first) {
    for (uint32_t i = first; i < first + 40; ++i) {
      const Tracker::Result result = Process(other_.Observe(i).frame);
      if (result.message) {
        island_ = std::get<InitialMap>(*result.message);
        EXPECT_EQ(result.report.tracked.state, TrackingState::kTracked);
        return (i - first) / world_.sensor().frames_per_second;
      }
      EXPECT_EQ(result.report.tracked.state, TrackingState::kLost);
      EXPECT_FALSE(result.report.failure) << "only a monocular camera waits for motion";
    }
    return std::nullopt;
  }

  const SyntheticWorld other_{{.points = 300, .seed = 77}};
  InitialMap island_;
};

TEST_F(LostDepthTracker, BeginsAnIslandAfterASecondAndFollowsIt) {
  Begin();
  TrackFrames(1, 3);
  const std::optional<double> waited = LoseUntilIsland(4);
  ASSERT_TRUE(waited);
  EXPECT_NEAR(*waited, 1.0, 0.04);
  ASSERT_EQ(island_.views.size(), 1u);
  std::vector<LandmarkId> created;
  InsertInitialMap(made_.map, island_, world_.sensor(), created);
  map_ = Publish(made_.map);
  const uint32_t next = island_.views.front().frame->id.value + 1;
  const Tracker::Result result = Process(other_.Observe(next).frame);
  ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked);
  EXPECT_EQ(IslandOf(*map_, result.report.tracked.from_keyframe->reference), IslandId(1));
}

TEST_F(LostDepthTracker, TheLostFramesGetPosesInTheIslandAtTheEnd) {
  Begin();
  TrackFrames(1, 3);
  ASSERT_TRUE(LoseUntilIsland(4));
  std::vector<LandmarkId> created;
  InsertInitialMap(made_.map, island_, world_.sensor(), created);
  ASSERT_TRUE(KeepOnlyIsland(made_.map, IslandId(1)));
  const std::vector<TrackedFrame> found = tracker_.LocaliseEarlyFrames(made_.map);
  ASSERT_GE(found.size(), 25u);
  EXPECT_GE(found.front().frame, FrameId(4));
}

// With one image a second, one lost frame says little.
TEST_F(LostDepthTracker, WaitsForSeveralFramesIfThereAreFewPerSecond) {
  Begin();
  TrackFrames(1, 3);
  for (uint32_t i = 4; i < 7; ++i) {
    auto frame = std::make_shared<Frame>(*other_.Observe(i).frame);
    frame->timestamp = i;
    const bool begins = Process(frame).message.has_value();
    EXPECT_EQ(begins, i == 6) << i;
  }
}

TEST_F(LostDepthTracker, CountsLostFramesAnewAfterTheCameraWasFound) {
  Begin();
  TrackFrames(1, 3);
  for (uint32_t i = 4; i < 10; ++i) {
    const bool is_known = i == 6;
    auto frame = std::make_shared<Frame>(*(is_known ? world_ : other_).Observe(i).frame);
    frame->timestamp = i;
    const Tracker::Result result = Process(frame);
    EXPECT_EQ(result.message.has_value(), i == 9) << i;
    EXPECT_EQ(result.report.tracked.state == TrackingState::kTracked, is_known || i == 9) << i;
  }
}

// Only place recognition can join the island to the other one, and it has seen this view.
TEST_F(LostDepthTracker, ACameraThatStandsStillAsksForFewKeyframesToJoinItsIsland) {
  Begin();
  TrackFrames(1, 3);
  ASSERT_TRUE(LoseUntilIsland(4));
  std::vector<LandmarkId> created;
  InsertInitialMap(made_.map, island_, world_.sensor(), created);
  map_ = Publish(made_.map);
  const uint32_t begin = island_.views.front().frame->id.value;
  const std::shared_ptr<const Frame> view = other_.Observe(begin).frame;
  int requests = 0;
  for (uint32_t i = begin + 1; i < begin + 400; ++i) {
    auto frame = std::make_shared<Frame>(*view);
    frame->id = FrameId(i);
    frame->timestamp = i / world_.sensor().frames_per_second;
    const Tracker::Result result = Process(frame);
    ASSERT_EQ(result.report.tracked.state, TrackingState::kTracked);
    requests += result.message ? 1 : 0;
  }
  EXPECT_GE(requests, 2) << "a join needs two keyframes";
  EXPECT_LE(requests, 4) << "40 if one were requested every third of a second";
}

TEST_F(LostDepthTracker, WithLocalizationOnlyNoIslandIsBegun) {
  tracker_.LocaliseOnly();
  map_ = Publish(made_.map);
  EXPECT_FALSE(LoseUntilIsland(4));
}

TEST_F(LostMonocularTracker, WithLocalizationOnlyNoIslandIsBegun) {
  tracker_.LocaliseOnly();
  EXPECT_EQ(BeginAndLose(3, 40), 0u);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/compaction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "features/find_near.h"
#include "frame/rolling_shutter.h"
#include "map/keyframe_graph.h"
#include "map/made_map.h"
#include "map/random_edits.h"
#include "map_files/invariants.h"

namespace hullslam {
namespace {

// The descriptor of every observation of every landmark, in the order of ids.
std::vector<Descriptor> ObservedDescriptors(const Map& map) {
  std::vector<Descriptor> descriptors;
  for (const auto& [id, landmark] : map.landmarks()) {
    for (const Observation& seen : landmark.observations) {
      descriptors.push_back(
          map.keyframes().At(seen.keyframe).frame->features.descriptors[seen.keypoint]);
    }
  }
  return descriptors;
}

// The class and the score of every observation of every object, in the order of ids.
std::vector<std::pair<std::string, double>> ObservedDetections(const Map& map) {
  std::vector<std::pair<std::string, double>> detections;
  for (const auto& [id, object] : map.objects()) {
    for (const ObjectObservation& seen : object.observations) {
      const Detection& detection =
          map.keyframes().At(seen.keyframe).frame->detections[seen.detection];
      detections.emplace_back(detection.label, detection.score);
    }
  }
  return detections;
}

// A keyframe whose keypoints have different descriptors.
KeyframeId AddDistinctKeyframe(Map& map, uint32_t number) {
  const auto frame = MakeFrame(number, 40, 20);
  for (uint32_t i = 0; i < 40; ++i) {
    frame->features.descriptors[i] = {number, i, 0, 0};
    frame->detections[i % kDetections].keypoints.push_back(i);
  }
  return map.AddKeyframe(frame, {});
}

TEST(Compaction, KeepsKeypointsWithLandmarksAndDetectionsWithObjects) {
  Map map;
  const KeyframeId a = AddDistinctKeyframe(map, 0);
  const KeyframeId b = AddDistinctKeyframe(map, 1);
  SetParent(map, b, a);
  const LandmarkId landmark = map.AddLandmark({0.0, 0.0, 2.0}, a);
  map.AddObservation(landmark, a, 17);
  map.AddObservation(landmark, b, 5);
  const ObjectId object = map.AddObject();
  map.AddObservation(object, a, 1);
  const Map before = map.Snapshot();
  CompactKeyframe(map, a);
  const Keyframe& compact = map.keyframes().At(a);
  ASSERT_EQ(compact.frame->features.size(), 1u);
  EXPECT_EQ(compact.frame->features.descriptors[0], (Descriptor{0, 17, 0, 0}));
  EXPECT_EQ(compact.landmarks, std::vector<LandmarkId>{landmark});
  ASSERT_EQ(compact.frame->detections.size(), 1u);
  EXPECT_EQ(compact.frame->detections[0].label, "book");
  EXPECT_EQ(compact.frame->detections[0].keypoints, std::vector<uint32_t>{0});
  EXPECT_EQ(compact.objects, std::vector<ObjectId>{object});
  EXPECT_EQ(map.landmarks().At(landmark).observations[0].keypoint, 0u);
  EXPECT_EQ(map.landmarks().At(landmark).observations[1].keypoint, 5u)
      << "the observation by the other keyframe";
  EXPECT_EQ(map.objects().At(object).observations[0].detection, 0u);
  EXPECT_EQ(map.keyframes().At(b).frame->features.size(), 40u);
  EXPECT_TRUE(FindViolations(map).empty());
  EXPECT_EQ(before.keyframes().At(a).frame->features.size(), 40u);
  EXPECT_EQ(before.landmarks().At(landmark).observations[0].keypoint, 17u);
  EXPECT_TRUE(FindViolations(before).empty());
}

// Each observation has the same descriptor, class and score afterwards, in any map.
TEST(Compaction, KeepsEveryObservationOfARandomMap) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    Map map;
    RandomEdits edits(seed);
    for (int i = 0; i < 150; ++i) {
      edits.Edit(map);
    }
    const std::vector<Descriptor> descriptors = ObservedDescriptors(map);
    const auto detections = ObservedDetections(map);
    std::vector<KeyframeId> ids;
    map.keyframes().ForEach([&](KeyframeId id, const Keyframe&) { ids.push_back(id); });
    for (const KeyframeId id : ids) {
      CompactKeyframe(map, id);
      EXPECT_EQ(FindViolations(map), std::vector<std::string>()) << "seed " << seed;
      const std::vector<LandmarkId>& landmarks = map.keyframes().At(id).landmarks;
      EXPECT_TRUE(std::all_of(landmarks.begin(), landmarks.end(),
                              [](LandmarkId landmark) { return landmark.IsValid(); }));
    }
    EXPECT_EQ(ObservedDescriptors(map), descriptors);
    EXPECT_EQ(ObservedDetections(map), detections);
    const std::string once = Dump(map);
    for (const KeyframeId id : ids) {
      CompactKeyframe(map, id);
    }
    EXPECT_EQ(Dump(map), once) << "a second time changes nothing";
  }
}

TEST(Compaction, ACompactKeyframeCanLoseAndGetObservationsAndBeCulled) {
  Map map;
  const KeyframeId a = AddKeyframe(map, 40, 20);
  const KeyframeId b = AddKeyframe(map, 40, 20);
  const KeyframeId c = AddKeyframe(map, 40, 20);
  const std::vector<LandmarkId> landmarks = Share(map, {a, b, c}, 20);
  UpdateCovisibility(map, b);
  UpdateCovisibility(map, c);
  CompactKeyframe(map, b);
  map.RemoveObservation(landmarks[3], b);
  EXPECT_FALSE(map.keyframes().At(b).landmarks[3].IsValid());
  EXPECT_TRUE(map.AddObservation(landmarks[3], b, 3));
  map.ReplaceLandmark(landmarks[4], landmarks[5]);
  EXPECT_TRUE(FindViolations(map).empty());
  CompactKeyframe(map, b);
  EXPECT_EQ(map.keyframes().At(b).frame->features.size(), 19u);
  map.CullKeyframe(b);
  EXPECT_TRUE(FindViolations(map).empty());
}

Frame MakeFullFrame() {
  Frame frame;
  frame.id = FrameId(7);
  frame.timestamp = 1.5;
  frame.motion = MotionPrior();
  FrameFeatures& features = frame.features;
  for (uint32_t i = 0; i < 10; ++i) {
    Keypoint& keypoint = features.keypoints.emplace_back();
    keypoint.undistorted = {40.0f * static_cast<float>(i) + 5.0f, 100.0f};
    keypoint.level = static_cast<int>(i % 3);
    features.descriptors.push_back({i, 2 * i, 3 * i, 4 * i});
    features.depth.push_back(static_cast<float>(i));
  }
  features.grid = FeatureGrid(features.keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  frame.detections.resize(3);
  frame.detections[0].label = "cup";
  frame.detections[1].label = "book";
  frame.detections[1].keypoints = {0, 2, 3, 9};
  frame.detections[2].label = "ball";
  frame.detections[2].keypoints = {1, 4};
  frame.depth = DepthGrid(cv::Mat(480, 640, CV_16UC1, cv::Scalar(1000)), 1000.0);
  return frame;
}

TEST(ReducedFrame, HasTheChosenKeypointsAndDetections) {
  const Frame frame = MakeFullFrame();
  const std::vector<uint32_t> keypoints = {2, 4, 9};
  const std::vector<uint32_t> detections = {1, 2};
  const auto reduced = ReduceFrame(frame, keypoints, detections);
  EXPECT_TRUE(reduced->motion) << "a motion prior tells what it ties";
  EXPECT_EQ(reduced->id, frame.id);
  EXPECT_EQ(reduced->timestamp, frame.timestamp);
  ASSERT_EQ(reduced->features.size(), 3u);
  for (size_t i = 0; i < keypoints.size(); ++i) {
    const size_t former = keypoints[i];
    EXPECT_EQ(reduced->features.keypoints[i].undistorted,
              frame.features.keypoints[former].undistorted);
    EXPECT_EQ(reduced->features.keypoints[i].level, frame.features.keypoints[former].level);
    EXPECT_EQ(reduced->features.descriptors[i], frame.features.descriptors[former]);
    EXPECT_EQ(reduced->features.depth[i], frame.features.depth[former]);
  }
  ASSERT_EQ(reduced->detections.size(), 2u);
  EXPECT_EQ(reduced->detections[0].label, "book");
  EXPECT_EQ(reduced->detections[0].keypoints, (std::vector<uint32_t>{0, 2}));
  EXPECT_EQ(reduced->detections[1].label, "ball");
  EXPECT_EQ(reduced->detections[1].keypoints, (std::vector<uint32_t>{1}));
  EXPECT_TRUE(reduced->depth.empty());
}

TEST(ReducedFrame, FindsItsKeypointsUnderTheirNewIndices) {
  const Frame frame = MakeFullFrame();
  const auto reduced = ReduceFrame(frame, std::vector<uint32_t>{2, 4, 9}, {});
  for (uint32_t i = 0; i < 3; ++i) {
    std::vector<uint32_t> found;
    FindNear(reduced->features.grid, reduced->features.keypoints,
             reduced->features.keypoints[i].undistorted, 1.0f, 0, 7, found);
    EXPECT_EQ(found, std::vector<uint32_t>{i});
  }
  EXPECT_TRUE(reduced->detections.empty());
}

TEST(ReducedFrame, KeepsHowTheShutterOfItsKeypointsWasCorrected) {
  Frame frame;
  frame.features.keypoints.resize(3);
  frame.features.descriptors.resize(3);
  frame.features.depth.resize(3);
  frame.features.grid = FeatureGrid(frame.features.keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  auto shutter = std::make_shared<ShutterMotion>();
  shutter->velocity.linear = {1.0, 2.0, 3.0};
  shutter->inverse_depths = {0.1, 0.2, 0.3};
  shutter->depths = {10.0F, 5.0F, 3.0F};
  frame.shutter = shutter;
  const std::vector<uint32_t> kept = {0, 2};
  const auto reduced = ReduceFrame(frame, kept, {});
  ASSERT_NE(reduced->shutter, nullptr);
  EXPECT_EQ(reduced->shutter->velocity.linear, shutter->velocity.linear);
  EXPECT_EQ(reduced->shutter->inverse_depths, (std::vector<double>{0.1, 0.3}));
  EXPECT_EQ(reduced->shutter->depths, (std::vector<float>{10.0F, 3.0F}));
}

TEST(ReducedFrame, CanHaveNoKeypoints) {
  const auto reduced = ReduceFrame(MakeFullFrame(), {}, {});
  EXPECT_EQ(reduced->features.size(), 0u);
  std::vector<uint32_t> found;
  FindNear(reduced->features.grid, {}, {100.0f, 100.0f}, 500.0f, 0, 7, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace hullslam

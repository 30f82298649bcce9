// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/compaction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "map/invariants.h"
#include "map/keyframe_graph.h"
#include "map/made_map.h"
#include "map/random_edits.h"

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

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/landmark_fusion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "map/invariants.h"
#include "support/synthetic_world.h"
#include "support/test_cameras.h"
#include "support/unknown_points.h"

namespace hullslam {
namespace {

bool Observes(const Map& map, KeyframeId keyframe, LandmarkId landmark) {
  const std::vector<LandmarkId>& slots = map.keyframes().At(keyframe).landmarks;
  return std::find(slots.begin(), slots.end(), landmark) != slots.end();
}

class LandmarkFusionTest : public testing::TestWithParam<TestCamera> {
 protected:
  // Every third of the landmarks that all three keyframes see with depth.
  std::vector<LandmarkId> Victims() const {
    std::vector<LandmarkId> victims;
    made_.map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
      if (landmark.observation_weight == 6 && id.value % 3 == 0) {
        victims.push_back(id);
      }
    });
    EXPECT_GT(victims.size(), 20u);
    return victims;
  }

  // Removes the keyframe's observation of the landmark and makes a second landmark of its keypoint.
  LandmarkId Split(LandmarkId landmark, KeyframeId keyframe, const Eigen::Vector3d& shift) {
    const uint32_t keypoint = Forget(landmark, keyframe);
    const LandmarkId twin =
        made_.map.AddLandmark(made_.map.landmarks().At(landmark).position + shift, keyframe);
    made_.map.AddObservation(twin, keyframe, keypoint);
    UpdateDescriptor(made_.map, twin);
    UpdateViewingGeometry(made_.map, twin, world_.sensor().levels);
    return twin;
  }
  uint32_t Forget(LandmarkId landmark, KeyframeId keyframe) {
    const std::vector<LandmarkId>& slots = made_.map.keyframes().At(keyframe).landmarks;
    const auto keypoint = std::find(slots.begin(), slots.end(), landmark) - slots.begin();
    made_.map.RemoveObservation(landmark, keyframe);
    return static_cast<uint32_t>(keypoint);
  }
  void Fuse(KeyframeId keyframe) {
    FuseLandmarks(made_.map, keyframe, world_.sensor());
    EXPECT_EQ(FindViolations(made_.map), std::vector<std::string>());
  }

  const SyntheticWorld world_{{}, GetParam().sensor};
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 5, 10});
  const KeyframeId newest_{2};
};

HULLSLAM_WITH_ALL_CAMERAS(LandmarkFusionTest);

TEST_P(LandmarkFusionTest, DoesNotChangeAMapWithoutDuplicates) {
  const size_t landmarks = made_.map.landmarks().size();
  Fuse(newest_);
  EXPECT_EQ(made_.map.landmarks().size(), landmarks);
}

TEST_P(LandmarkFusionTest, MergesDuplicatesOfTheKeyframe) {
  const size_t landmarks = made_.map.landmarks().size();
  std::vector<std::pair<LandmarkId, LandmarkId>> twins;
  for (const LandmarkId victim : Victims()) {
    twins.emplace_back(victim, Split(victim, newest_, {0.001, -0.001, 0.002}));
  }
  Fuse(newest_);
  EXPECT_EQ(made_.map.landmarks().size(), landmarks);
  for (const auto& [victim, twin] : twins) {
    EXPECT_EQ(made_.map.Resolve(twin), victim)
        << "the one with the larger observation weight stays";
    EXPECT_EQ(made_.map.landmarks().At(victim).observations.size(), 3u);
    EXPECT_TRUE(Observes(made_.map, newest_, victim));
  }
}

TEST_P(LandmarkFusionTest, MergesDuplicatesInANeighbour) {
  std::vector<std::pair<LandmarkId, LandmarkId>> twins;
  for (const LandmarkId victim : Victims()) {
    twins.emplace_back(victim, Split(victim, KeyframeId(0), {0.001, -0.001, 0.002}));
  }
  Fuse(newest_);
  for (const auto& [victim, twin] : twins) {
    EXPECT_EQ(made_.map.Resolve(twin), victim);
    EXPECT_TRUE(Observes(made_.map, KeyframeId(0), victim));
  }
}

TEST_P(LandmarkFusionTest, AddsObservationsAtFreeKeypoints) {
  const std::vector<LandmarkId> victims = Victims();
  for (const LandmarkId victim : victims) {
    Forget(victim, newest_);
  }
  UpdateCovisibility(made_.map, newest_);
  const int shared_before = made_.map.keyframes().At(newest_).covisible[0].shared;
  Fuse(newest_);
  for (const LandmarkId victim : victims) {
    EXPECT_TRUE(Observes(made_.map, newest_, victim));
  }
  EXPECT_EQ(made_.map.keyframes().At(newest_).covisible[0].shared,
            shared_before + static_cast<int>(victims.size()))
      << "the edges are updated";
}

TEST_P(LandmarkFusionTest, DoesNotMergePointsWithDifferentDescriptors) {
  std::vector<std::pair<LandmarkId, LandmarkId>> neighbours;
  for (const LandmarkId victim : Victims()) {
    const LandmarkId twin = Split(victim, newest_, Eigen::Vector3d::Zero());
    Descriptor& descriptor = made_.map.MutableLandmark(twin).descriptor;
    for (uint64_t& word : descriptor) {
      word = ~word;
    }
    neighbours.emplace_back(victim, twin);
  }
  for (const auto& [victim, twin] : neighbours) {
    Descriptor& descriptor = made_.map.MutableLandmark(victim).descriptor;
    for (uint64_t& word : descriptor) {
      word ^= 0x5555555555555555;  // half of all bits
    }
  }
  Fuse(newest_);
  for (const auto& [victim, twin] : neighbours) {
    EXPECT_TRUE(made_.map.landmarks().Contains(victim));
    EXPECT_TRUE(made_.map.landmarks().Contains(twin));
  }
}

TEST_P(LandmarkFusionTest, DoesNotMergePointsFarFromTheKeypoint) {
  std::vector<LandmarkId> twins;
  for (const LandmarkId victim : Victims()) {
    const Landmark& landmark = made_.map.landmarks().At(victim);
    const double depth = (made_.map.CamFromWorld(newest_) * landmark.position).z();
    // Above or below the keypoints, outside of every search window: 50 px, 40 or more in the raw
    // image of the fisheye.
    const double shift =
        50.0 / world_.sensor().camera.fy * depth * (world_.sensor().camera.IsFisheye() ? 2.5 : 1.0);
    made_.map.SetPosition(victim, landmark.position + Eigen::Vector3d(0.0, shift, 0.0));
    twins.push_back(Split(victim, newest_, {0.0, -2.0 * shift, 0.0}));
  }
  Fuse(newest_);
  for (const LandmarkId twin : twins) {
    EXPECT_TRUE(made_.map.landmarks().Contains(twin));
  }
}

// Near each keypoint of the third keyframe there is another one with a more similar descriptor, but
// too far away to be the landmark.
class LandmarkFusionWith : public testing::TestWithParam<TestCamera> {};

HULLSLAM_WITH_ALL_CAMERAS(LandmarkFusionWith);

TEST_P(LandmarkFusionWith, TakesTheMostSimilarKeypointThatAgreesWithTheProjection) {
  const SyntheticWorld world({}, GetParam().sensor);
  const KeyframeId newest(2);
  SyntheticMap made = MakeSyntheticMap(world, {0, 5, 10}, [&](Frame& frame, const Rigid3&) {
    FrameFeatures& features = frame.features;
    const size_t count = frame.id == FrameId(10) ? features.size() : 0;
    for (size_t i = 0; i < count; ++i) {
      Keypoint decoy = features.keypoints[i];
      const float shift = 2.8f * world.sensor().levels.scale[static_cast<size_t>(decoy.level)];
      const Eigen::Vector2d pixel = world.sensor().camera.Distort(decoy.undistorted.cast<double>());
      decoy.undistorted =
          world.sensor()
              .camera.Undistort(pixel + Eigen::Vector2d::Constant(static_cast<double>(shift)))
              .cast<float>();
      features.keypoints.push_back(decoy);
      features.descriptors.push_back(features.descriptors[i]);
      features.depth.push_back(features.depth[i]);
      features.descriptors[i][0] ^= 0xfffff;  // 20 bits
    }
    RebuildGrid(world.sensor(), frame);
  });
  std::vector<std::pair<LandmarkId, uint32_t>> forgotten;
  for (uint32_t i = 0; i < made.views[2].points.size(); i += 3) {
    const LandmarkId landmark = made.landmarks[made.views[2].points[i]];
    if (landmark.IsValid() && made.map.landmarks().At(landmark).observation_weight == 6) {
      made.map.RemoveObservation(landmark, newest);
      forgotten.emplace_back(landmark, i);
    }
  }
  ASSERT_GT(forgotten.size(), 20u);
  FuseLandmarks(made.map, newest, world.sensor());
  for (const auto& [landmark, keypoint] : forgotten) {
    EXPECT_EQ(made.map.keyframes().At(newest).landmarks[keypoint], landmark);
  }
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/landmark_creation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "map/keyframe_graph.h"
#include "map_files/invariants.h"
#include "support/synthetic_world.h"
#include "support/test_cameras.h"
#include "support/unknown_points.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

struct TwoKeyframes {
  Map map;
  SyntheticView a;
  SyntheticView b;
};

// Two keyframes that share every fourth point they both see as a landmark; the other keypoints are
// free. `change` may alter the second frame before it is used.
TwoKeyframes MakePair(const SyntheticWorld& world, const Rigid3& a_from_world,
                      const Rigid3& b_from_world,
                      const std::function<void(Frame&)>& change = nullptr) {
  TwoKeyframes pair;
  pair.a = world.Observe(FrameId(0), a_from_world);
  pair.b = world.Observe(FrameId(1), b_from_world);
  if (change) {
    auto changed = std::make_shared<Frame>(*pair.b.frame);
    change(*changed);
    pair.b.frame = changed;
  }
  const KeyframeId a = pair.map.AddKeyframe(pair.a.frame, a_from_world);
  const KeyframeId b = pair.map.AddKeyframe(pair.b.frame, b_from_world);
  std::map<uint32_t, uint32_t> keypoint_in_a;
  for (uint32_t k = 0; k < pair.a.points.size(); ++k) {
    keypoint_in_a[pair.a.points[k]] = k;
  }
  for (uint32_t k = 0; k < pair.b.points.size(); ++k) {
    const uint32_t point = pair.b.points[k];
    if (point % 4 == 0 && keypoint_in_a.contains(point)) {
      const LandmarkId landmark = pair.map.AddLandmark(world.points()[point], a);
      pair.map.AddObservation(landmark, a, keypoint_in_a[point]);
      pair.map.AddObservation(landmark, b, k);
    }
  }
  UpdateCovisibility(pair.map, b);
  SetParent(pair.map, b, a);
  return pair;
}

Rigid3 LookingAhead(const Eigen::Vector3d& center) {
  return {Eigen::Quaterniond::Identity(), -center};
}

// The point of the world that the landmark was made from. Each point has its own descriptor.
uint32_t PointOf(const SyntheticWorld& world, const Landmark& landmark) {
  for (uint32_t i = 0; i < world.points().size(); ++i) {
    if (world.descriptor(i) == landmark.descriptor) {
      return i;
    }
  }
  ADD_FAILURE() << "no such descriptor";
  return 0;
}

double ParallaxDegrees(const Eigen::Vector3d& point, const Eigen::Vector3d& center_a,
                       const Eigen::Vector3d& center_b) {
  const Eigen::Vector3d a = (point - center_a).normalized();
  const Eigen::Vector3d b = (point - center_b).normalized();
  return std::acos(std::min(1.0, a.dot(b))) * 180.0 / std::numbers::pi;
}

// Counts the free points seen in both images for which `holds`.
size_t CountFreeShared(const SyntheticWorld& world, const TwoKeyframes& pair,
                       const std::function<bool(const Eigen::Vector3d&)>& holds) {
  size_t count = 0;
  for (const uint32_t point : pair.b.points) {
    const bool in_both =
        std::find(pair.a.points.begin(), pair.a.points.end(), point) != pair.a.points.end();
    count += point % 4 != 0 && in_both && holds(world.points()[point]) ? 1 : 0;
  }
  return count;
}

class LandmarkCreationWith : public testing::TestWithParam<TestCamera> {};

HULLSLAM_WITH_ALL_CAMERAS(LandmarkCreationWith);

TEST_P(LandmarkCreationWith, KeypointsWithoutDepthAreTriangulated) {
  const SyntheticWorld world({.depth_share = 0.0}, GetParam().sensor);
  const Eigen::Vector3d center(0.3, 0.0, 0.0);
  TwoKeyframes pair = MakePair(world, Rigid3(), LookingAhead(center));
  const std::vector<LandmarkId> created = CreateLandmarks(pair.map, KeyframeId(1), world.sensor());
  EXPECT_EQ(FindViolations(pair.map), std::vector<std::string>());
  const size_t clear = CountFreeShared(world, pair, [&](const Eigen::Vector3d& point) {
    return ParallaxDegrees(point, Eigen::Vector3d::Zero(), center) > 1.2;
  });
  EXPECT_GT(clear, 100u);
  EXPECT_GE(created.size(), clear);
  for (const LandmarkId id : created) {
    const Landmark& landmark = pair.map.landmarks().At(id);
    EXPECT_LT((landmark.position - world.points()[PointOf(world, landmark)]).norm(), 1e-4);
    EXPECT_EQ(landmark.observations.size(), 2u);
    EXPECT_EQ(landmark.created_by, KeyframeId(1));
    EXPECT_GT(landmark.max_distance, 0.0);
  }
}

TEST_P(LandmarkCreationWith, SmallParallaxWithoutDepthGivesNoLandmark) {
  const SyntheticWorld world({.depth_share = 0.0}, GetParam().sensor);
  const Eigen::Vector3d center(0.09, 0.0, 0.0);
  TwoKeyframes pair = MakePair(world, Rigid3(), LookingAhead(center));
  const std::vector<LandmarkId> created = CreateLandmarks(pair.map, KeyframeId(1), world.sensor());
  EXPECT_EQ(FindViolations(pair.map), std::vector<std::string>());
  for (const LandmarkId id : created) {
    const uint32_t point = PointOf(world, pair.map.landmarks().At(id));
    EXPECT_GT(ParallaxDegrees(world.points()[point], Eigen::Vector3d::Zero(), center), 1.1);
  }
  const auto parallax = [&](const Eigen::Vector3d& point) {
    return ParallaxDegrees(point, Eigen::Vector3d::Zero(), center);
  };
  EXPECT_GE(created.size(), CountFreeShared(world, pair, [&](const Eigen::Vector3d& point) {
              return parallax(point) > 1.2;
            }));
  EXPECT_GT(CountFreeShared(world, pair, [&](const auto& p) { return parallax(p) < 1.1; }), 20u);
}

TEST_P(LandmarkCreationWith, NothingIsTriangulatedWithinTheVirtualBaseline) {
  const SyntheticWorld world({}, GetParam().sensor);
  TwoKeyframes pair =
      MakePair(world, Rigid3(), LookingAhead({0.99 * world.sensor().baseline(), 0.0, 0.0}));
  EXPECT_TRUE(CreateLandmarks(pair.map, KeyframeId(1), world.sensor()).empty());
}

TEST_P(LandmarkCreationWith, DepthReplacesParallax) {
  const SyntheticWorld world({}, GetParam().sensor);
  TwoKeyframes pair = MakePair(world, Rigid3(), LookingAhead({0.0, 0.0, 0.1}));
  const std::vector<LandmarkId> created = CreateLandmarks(pair.map, KeyframeId(1), world.sensor());
  EXPECT_EQ(FindViolations(pair.map), std::vector<std::string>());
  const size_t shared = CountFreeShared(world, pair, [](const auto&) { return true; });
  EXPECT_GT(shared, 100u);
  EXPECT_GT(created.size(), shared * 9 / 10);
  for (const LandmarkId id : created) {
    const Landmark& landmark = pair.map.landmarks().At(id);
    EXPECT_LT((landmark.position - world.points()[PointOf(world, landmark)]).norm(), 1e-4);
  }
}

// If the camera is 1.5 m nearer, a patch is found up to seven levels of the pyramid higher.
TEST_P(LandmarkCreationWith, LevelsThatChangeWithTheDistancesAreConsistent) {
  const SyntheticWorld world({.depth_share = 0.0}, GetParam().sensor);
  const Eigen::Vector3d center(0.4, 0.0, 1.5);
  TwoKeyframes pair = MakePair(world, Rigid3(), LookingAhead(center));
  const std::vector<LandmarkId> created = CreateLandmarks(pair.map, KeyframeId(1), world.sensor());
  const auto has_parallax = [&](const Eigen::Vector3d& point) {
    return ParallaxDegrees(point, Eigen::Vector3d::Zero(), center) > 3.0;
  };
  const size_t shared = CountFreeShared(world, pair, has_parallax);
  EXPECT_GT(shared, 50u);
  EXPECT_GT(created.size(), shared * 9 / 10);
}

TEST_P(LandmarkCreationWith, LevelsThatContradictTheDistancesAreRefused) {
  const SyntheticWorld world({.depth_share = 0.0}, GetParam().sensor);
  const auto raise = [](Frame& frame) {
    for (Keypoint& keypoint : frame.features.keypoints) {
      keypoint.level = keypoint.level < 4 ? keypoint.level + 4 : keypoint.level - 4;
    }
  };
  TwoKeyframes pair = MakePair(world, Rigid3(), LookingAhead({0.3, 0.0, 0.0}), raise);
  const size_t shared = CountFreeShared(world, pair, [](const auto&) { return true; });
  const std::vector<LandmarkId> created = CreateLandmarks(pair.map, KeyframeId(1), world.sensor());
  EXPECT_LT(created.size(), shared / 10) << "about as far away but four levels apart";
}

TEST_P(LandmarkCreationWith, PointsOffTheEpipolarLineAreRefused) {
  const SyntheticWorld world({.depth_share = 0.0}, GetParam().sensor);
  const auto shift = [&](Frame& frame) {
    for (Keypoint& keypoint : frame.features.keypoints) {
      const Eigen::Vector2d pixel =
          world.sensor().camera.Distort(keypoint.undistorted.cast<double>());
      keypoint.undistorted =
          world.sensor().camera.Undistort(pixel + Eigen::Vector2d(0.0, 15.0)).cast<float>();
    }
  };
  TwoKeyframes pair = MakePair(world, Rigid3(), LookingAhead({0.3, 0.0, 0.0}), shift);
  EXPECT_TRUE(CreateLandmarks(pair.map, KeyframeId(1), world.sensor()).empty());
}

TEST(LandmarkCreation, AKeyframeWithoutNeighboursMakesNoLandmark) {
  const SyntheticWorld world;
  Map map;
  const KeyframeId id = map.AddKeyframe(world.Observe(0).frame, Rigid3());
  EXPECT_TRUE(CreateLandmarks(map, id, world.sensor()).empty());
  EXPECT_TRUE(map.landmarks().empty());
}

// When the camera moves along its viewing direction, points near the epipole have little parallax,
// whether the new keyframe is in front of the old one or behind it.
TEST(LandmarkCreation, KeypointsNearTheEpipoleGiveNoLandmark) {
  const SyntheticWorld world({.points = 3000, .depth_share = 0.0});
  const Sensor& sensor = world.sensor();
  for (const double z : {-1.9, 1.0}) {
    const Eigen::Vector3d center(0.0, 0.0, z);
    TwoKeyframes pair = MakePair(world, Rigid3(), LookingAhead(center));
    const std::vector<LandmarkId> created = CreateLandmarks(pair.map, KeyframeId(1), sensor);
    // px in keyframe 0 over the least distance
    const auto epipole_distance = [&](const Eigen::Vector3d& point, int level) {
      return (sensor.camera.Project(point) - Eigen::Vector2d(sensor.camera.cx, sensor.camera.cy))
                 .norm() /
             (10.0 * static_cast<double>(sensor.levels.scale[static_cast<size_t>(level)]));
    };
    for (const LandmarkId id : created) {
      const Landmark& landmark = pair.map.landmarks().At(id);
      const Observation& seen = landmark.observations.front();
      ASSERT_EQ(seen.keyframe, KeyframeId(0));
      const int level = pair.a.frame->features.keypoints[seen.keypoint].level;
      EXPECT_GT(epipole_distance(landmark.position, level), 0.99) << z;
    }
    EXPECT_GT(created.size(), 100u) << z;
  }
}

Sensor Monocular(const SyntheticWorld& world) {
  Sensor sensor = world.sensor();
  sensor.kind = SensorKind::kMonocular;
  return sensor;
}

// Keypoints at coarse levels are less precise, so they need more parallax. It is that of the image
// as read. All points are at least 2 m ahead, so no neighbours let expect more than there.
TEST_P(LandmarkCreationWith, AMonocularPairNeedsParallaxInStandardDeviations) {
  const SyntheticWorld world({.points = 3000, .depth_share = 0.0}, GetParam().sensor);
  const Sensor sensor = Monocular(world);
  const Eigen::Vector3d center(25.0 / sensor.camera.fx, 0.0, 0.0);
  TwoKeyframes pair = MakePair(world, Rigid3(), LookingAhead(center));
  const std::vector<LandmarkId> created = CreateLandmarks(pair.map, KeyframeId(1), sensor);
  EXPECT_EQ(FindViolations(pair.map), std::vector<std::string>());
  ASSERT_GT(created.size(), 50U);
  const auto most_parallax = [&](const Eigen::Vector3d& position) {
    const Eigen::Vector3d infinite = (position - center) / (position - center).z();
    return (sensor.camera.Distort(sensor.camera.Project(infinite + center / 2.0)) -
            sensor.camera.Distort(sensor.camera.Project(infinite)))
        .norm();
  };
  double largest = 0.0;
  for (const LandmarkId id : created) {
    const Landmark& landmark = pair.map.landmarks().At(id);
    double variance = 0.0;  // px^2
    for (const Observation& seen : landmark.observations) {
      const Keypoint& keypoint =
          pair.map.keyframes().At(seen.keyframe).frame->features.keypoints[seen.keypoint];
      variance += static_cast<double>(sensor.levels.sigma2[static_cast<size_t>(keypoint.level)]);
    }
    largest = std::max(largest, std::sqrt(variance));
    EXPECT_LT(2.0 * std::sqrt(variance), most_parallax(landmark.position));
  }
  EXPECT_GT(largest, 2.0) << "coarse levels are not refused as such";
  EXPECT_LT(created.size(), CountFreeShared(world, pair, [](const auto&) { return true; }));
}

// If the parallax of each pair decided, the pairs would be chosen whose noise makes the parallax
// larger, and their points would be too near.
TEST_P(LandmarkCreationWith, NoiseDoesNotChooseMonocularPairs) {
  const SyntheticWorld world({.points = 3000, .pixel_noise = 0.7, .depth_share = 0.0},
                             GetParam().sensor);
  const Eigen::Vector3d center(22.5 / world.sensor().camera.fx, 0.0, 0.0);
  TwoKeyframes pair = MakePair(world, Rigid3(), LookingAhead(center));
  const std::vector<LandmarkId> created =
      CreateLandmarks(pair.map, KeyframeId(1), Monocular(world));
  std::vector<double> ratios;  // estimated over true inverse depth of far points
  for (const LandmarkId id : created) {
    const Landmark& landmark = pair.map.landmarks().At(id);
    const double depth = world.points()[PointOf(world, landmark)].z();
    if (depth > 4.0) {
      ratios.push_back(depth / landmark.position.z());
    }
  }
  ASSERT_GT(ratios.size(), 50U);
  EXPECT_NEAR(Median(ratios), 1.0, 0.07);
}

// By the rule of ORB-SLAM2 the parallax of each pair decides, so noise makes far points too near.
TEST(LandmarkCreation, ByTheRuleOfOrbSlam2TheOwnParallaxDecides) {
  const SyntheticWorld world({.points = 3000, .pixel_noise = 0.7, .depth_share = 0.0});
  TwoKeyframes pair = MakePair(world, Rigid3(), LookingAhead({0.1, 0.0, 0.0}));
  const std::vector<LandmarkId> created =
      CreateLandmarks(pair.map, KeyframeId(1), Monocular(world), MappingRule::kOrbSlam2);
  ASSERT_GT(created.size(), 20U);
  const double max_cos = 0.9998;
  for (const LandmarkId id : created) {
    const Eigen::Vector3d& position = pair.map.landmarks().At(id).position;
    const Eigen::Vector3d other = position - Eigen::Vector3d(0.1, 0.0, 0.0);
    EXPECT_LT(position.normalized().dot(other.normalized()), max_cos + 1e-4);
  }
}

TEST_P(LandmarkCreationWith, AMonocularCameraThatStandsStillMakesNone) {
  const SyntheticWorld world({.depth_share = 0.0}, GetParam().sensor);
  TwoKeyframes pair = MakePair(world, Rigid3(), LookingAhead({0.005, 0.0, 0.0}));
  EXPECT_TRUE(CreateLandmarks(pair.map, KeyframeId(1), Monocular(world)).empty());
}

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/landmark_creation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "map/invariants.h"
#include "map/keyframe_graph.h"
#include "support/synthetic_world.h"
#include "support/test_cameras.h"
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

}  // namespace
}  // namespace hullslam

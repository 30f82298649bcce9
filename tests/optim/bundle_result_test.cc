// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_result.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "map/invariants.h"
#include "support/pose_distance.h"
#include "support/random_geometry.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// A map of the synthetic world, and a result that moves its landmarks and all but the first two
// keyframes, and removes five observations of keyframe 3.
class ApplyBundleTest : public ::testing::Test {
 protected:
  ApplyBundleTest() {
    RandomGeometry random(1);
    for (uint32_t i = 2; i < made_.views.size(); ++i) {
      const Rigid3& pose = made_.map.keyframes().At(KeyframeId(i)).cam_from_world;
      result_.poses.emplace_back(KeyframeId(i), random.Pose(0.005, 0.02) * pose);
    }
    for (const LandmarkId id : made_.landmarks) {
      if (id.IsValid()) {
        result_.positions.emplace_back(id,
                                       made_.map.landmarks().At(id).position + random.Vector(0.02));
      }
    }
    for (const LandmarkId id : made_.map.keyframes().At(KeyframeId(3)).landmarks) {
      if (id.IsValid() && result_.outliers.size() < 5 &&
          made_.map.landmarks().At(id).observations.size() > 4) {
        result_.outliers.emplace_back(id, KeyframeId(3));
      }
    }
    EXPECT_EQ(result_.outliers.size(), 5u);
  }

  const SyntheticWorld world_{{.points = 300, .depth_share = 0.7}};
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 10, 20, 30, 40, 50});
  BundleResult result_;
};

TEST_F(ApplyBundleTest, WritesPosesPositionsAndRemovesOutliers) {
  ApplyBundle(made_.map, result_, world_.sensor().levels);
  EXPECT_EQ(FindViolations(made_.map), std::vector<std::string>());
  for (const auto& [id, pose] : result_.poses) {
    EXPECT_EQ(Distance(made_.map.keyframes().At(id).cam_from_world, pose), 0.0);
  }
  for (const auto& [id, position] : result_.positions) {
    const Landmark& landmark = made_.map.landmarks().At(id);
    EXPECT_EQ(landmark.position, position);
    // The distances are computed from the new camera centres.
    const Keyframe& reference = made_.map.keyframes().At(landmark.reference);
    EXPECT_GE(landmark.max_distance, (reference.cam_from_world * position).norm() * (1.0 - 1e-9));
  }
  for (const auto& [landmark, keyframe] : result_.outliers) {
    for (const Observation& observation : made_.map.landmarks().At(landmark).observations) {
      EXPECT_NE(observation.keyframe, keyframe);
    }
  }
}

TEST_F(ApplyBundleTest, SkipsEntitiesThatNoLongerExist) {
  made_.map.CullKeyframe(KeyframeId(4));
  const auto [first, keyframe] = result_.outliers[0];
  made_.map.EraseLandmark(first);
  made_.map.RemoveObservation(result_.outliers[1].first, keyframe);
  const LandmarkId newcomer = made_.map.AddLandmark({1.0, 1.0, 3.0}, KeyframeId(5));
  const Rigid3 culled_from_parent =
      made_.map.CamFromWorld(KeyframeId(4)) *
      Inverse(made_.map.CamFromWorld(made_.map.NearestAlive(KeyframeId(4))));

  ApplyBundle(made_.map, result_, world_.sensor().levels);
  EXPECT_EQ(FindViolations(made_.map), std::vector<std::string>());
  EXPECT_FALSE(made_.map.keyframes().Contains(KeyframeId(4)));
  EXPECT_FALSE(made_.map.landmarks().Contains(first));
  EXPECT_EQ(made_.map.landmarks().At(newcomer).position, Eigen::Vector3d(1.0, 1.0, 3.0));
  // The culled keyframe moves with its parent.
  EXPECT_LT(
      Distance(made_.map.CamFromWorld(KeyframeId(4)),
               culled_from_parent * made_.map.CamFromWorld(made_.map.NearestAlive(KeyframeId(4)))),
      1e-12);
  EXPECT_EQ(result_.poses.back().first, KeyframeId(5));
  EXPECT_EQ(Distance(made_.map.CamFromWorld(KeyframeId(5)), result_.poses.back().second), 0.0);
}

}  // namespace
}  // namespace hullslam

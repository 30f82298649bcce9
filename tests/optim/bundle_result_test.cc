// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_result.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "map_files/invariants.h"
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

// A result that is the map shrunk towards the camera of keyframe 0.
class BundleScale : public testing::Test {
 protected:
  void Shrink(double scale) {
    const Eigen::Vector3d center = Inverse(made_.map.CamFromWorld(KeyframeId(0))).translation;
    const auto shrink = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
      return center + scale * (point - center);
    };
    for (uint32_t i = 1; i < 4; ++i) {
      Rigid3 pose = made_.map.CamFromWorld(KeyframeId(i));
      pose.translation = -(pose.rotation * shrink(Inverse(pose).translation));
      result_.poses.emplace_back(KeyframeId(i), pose);
    }
    for (const auto& [id, landmark] : made_.map.landmarks()) {
      result_.positions.emplace_back(id, shrink(landmark.position));
    }
    Ellipsoid ellipsoid;
    ellipsoid.world_from_object.translation = shrink({0.3, 0.2, 3.0});
    ellipsoid.half_axes = scale * Eigen::Vector3d(0.1, 0.2, 0.3);
    result_.ellipsoids.emplace_back(ObjectId(0), ellipsoid);
  }

  const SyntheticWorld world_{{.points = 100}};
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 10, 20, 30});
  BundleResult result_;
};

TEST_F(BundleScale, IsThatOfTheMapAgain) {
  for (const double scale : {0.1, 0.9, 3.0}) {
    result_ = {};
    Shrink(scale);
    KeepScale(made_.map, KeyframeId(0), result_);
    for (const auto& [id, pose] : result_.poses) {
      EXPECT_LT((pose.ToMatrix() - made_.map.CamFromWorld(id).ToMatrix()).norm(), 1e-12);
    }
    for (const auto& [id, position] : result_.positions) {
      EXPECT_LT((position - made_.map.landmarks().At(id).position).norm(), 1e-12);
    }
    const Ellipsoid& ellipsoid = result_.ellipsoids.front().second;
    EXPECT_LT((ellipsoid.world_from_object.translation - Eigen::Vector3d(0.3, 0.2, 3.0)).norm(),
              1e-12);
    EXPECT_LT((ellipsoid.half_axes - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-12);
  }
}

TEST_F(BundleScale, CamerasAtOnePositionHaveNone) {
  Shrink(1.0);
  for (auto& [id, pose] : result_.poses) {
    pose = made_.map.CamFromWorld(KeyframeId(0));
  }
  const BundleResult before = result_;
  KeepScale(made_.map, KeyframeId(0), result_);
  EXPECT_EQ(result_.poses.front().second.ToMatrix(), before.poses.front().second.ToMatrix());
  EXPECT_EQ(result_.positions.front().second, before.positions.front().second);
}

}  // namespace
}  // namespace hullslam

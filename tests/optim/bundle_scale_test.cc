// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_result.h"

#include <gtest/gtest.h>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

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

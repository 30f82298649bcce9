// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/image_overlap.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

class ViewOverlap : public testing::Test {
 protected:
  // The pose of keyframe 0, turned to the side.
  Rigid3 Turned(double radians) const {
    return Rigid3(ExpSo3({0.0, radians, 0.0}), Eigen::Vector3d::Zero()) * keyframe_.cam_from_world;
  }
  double Share(double radians) const {
    return ShareInImage(made_.map, world_.sensor(), Turned(radians), keyframe_.landmarks);
  }

  const SyntheticWorld world_;
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 5});
  const Keyframe& keyframe_ = made_.map.keyframes().At(KeyframeId(0));
};

TEST_F(ViewOverlap, IsTheShareOfTheLandmarksInTheImage) {
  EXPECT_EQ(Share(0.0), 1.0);
  EXPECT_GT(Share(0.1), Share(0.2));
  EXPECT_NEAR(Share(0.2), Share(-0.2), 0.1);
  EXPECT_EQ(Share(3.14), 0.0) << "they are behind the camera";
}

TEST_F(ViewOverlap, IdsWithoutLandmarkAreLeftOut) {
  const std::vector<LandmarkId> none = {LandmarkId(), LandmarkId(1000000)};
  EXPECT_EQ(ShareInImage(made_.map, world_.sensor(), Turned(0.0), none), 1.0);
}

TEST_F(ViewOverlap, AnotherMotionLosesAsMuchAgain) {
  LastFrame last;
  last.landmarks = keyframe_.landmarks;
  const auto next = [&](double radians) {
    return NextOverlap(made_.map, world_.sensor(), Turned(radians), KeyframeId(0), last);
  };
  EXPECT_EQ(next(0.0), 1.0) << "a camera that stands still loses nothing";
  EXPECT_DOUBLE_EQ(next(0.2), 2.0 * Share(0.2) - 1.0);
  last.landmarks.clear();
  EXPECT_DOUBLE_EQ(next(0.2), Share(0.2)) << "the motion is not known";
}

}  // namespace
}  // namespace hullslam

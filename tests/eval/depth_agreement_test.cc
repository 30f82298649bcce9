// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/depth_agreement.h"

#include <gtest/gtest.h>

#include <memory>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// Multiplies all measured depths of the map's frames by `factor`.
void ScaleDepth(Map& map, double factor) {
  for (const KeyframeId id : {KeyframeId(0), KeyframeId(1), KeyframeId(2)}) {
    auto frame = std::make_shared<Frame>(*map.keyframes().At(id).frame);
    for (float& depth : frame->features.depth) {
      depth *= static_cast<float>(factor);
    }
    map.MutableKeyframe(id).frame = std::move(frame);
  }
}

TEST(CompareDepth, AgreesInAPerfectMap) {
  const SyntheticWorld world;
  const SyntheticMap made = MakeSyntheticMap(world, {0, 10, 20});
  const auto agreement = CompareDepth(made.map, world.sensor().camera);
  ASSERT_TRUE(agreement);
  EXPECT_GT(agreement->points, 50u);
  EXPECT_LT(agreement->deviation, 1e-3);
}

TEST(CompareDepth, ShowsDepthThatDoesNotFitTheMotion) {
  const SyntheticWorld world;
  SyntheticMap made = MakeSyntheticMap(world, {0, 10, 20});
  ScaleDepth(made.map, 1.25);
  EXPECT_NEAR(CompareDepth(made.map, world.sensor().camera)->deviation, 0.25, 1e-3);
  ScaleDepth(made.map, 0.8 / 1.25);
  EXPECT_NEAR(CompareDepth(made.map, world.sensor().camera)->deviation, 0.2, 1e-3);
}

TEST(CompareDepth, IsAbsentWithoutDepthOrParallax) {
  const SyntheticWorld world;
  SyntheticMap made = MakeSyntheticMap(world, {0, 10, 20});
  ScaleDepth(made.map, 0.0);
  EXPECT_FALSE(CompareDepth(made.map, world.sensor().camera));
  const SyntheticMap still = MakeSyntheticMap(world, {0, 1});
  EXPECT_FALSE(CompareDepth(still.map, world.sensor().camera));
  EXPECT_FALSE(CompareDepth(Map(), world.sensor().camera));
}

}  // namespace
}  // namespace hullslam

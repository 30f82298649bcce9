// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/keyframe_images.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// The frames 0 to 30 of the synthetic world, whose keyframes are 0, 10 and 20.
ImageSequence MadeSequence() {
  ImageSequence sequence;
  for (size_t i = 0; i <= 30; ++i) {
    sequence.frames.push_back(
        {static_cast<double>(i) / 30.0, "rgb/frame " + std::to_string(i) + ".jpg", {}, i});
  }
  return sequence;
}

TEST(KeyframeImages, AreFoundByTheirTimeStamps) {
  const SyntheticWorld world;
  const Map map = MakeSyntheticMap(world, {0, 10, 20}).map;
  const std::vector<KeyframeImage> images = FindKeyframeImages(map, MadeSequence(), "desk");
  ASSERT_EQ(images.size(), 3U);
  EXPECT_EQ(images[1].keyframe, KeyframeId(1));
  EXPECT_EQ(images[1].frame.number, 10U);
  EXPECT_EQ(images[1].name, "frame_10");
}

TEST(KeyframeImages, OfOtherTimesAreLeftOut) {
  const SyntheticWorld world;
  const Map map = MakeSyntheticMap(world, {0, 10, 40}).map;
  EXPECT_EQ(FindKeyframeImages(map, MadeSequence(), "desk").size(), 2U);
}

TEST(KeyframeImages, OfOtherSessionsAreLeftOut) {
  const SyntheticWorld world;
  Map map;
  map.BeginSession({"desk", FrameId(0)});
  map.AddKeyframe(world.Observe(0).frame, Rigid3());
  EXPECT_EQ(FindKeyframeImages(map, MadeSequence(), "renamed").size(), 1U)
      << "with one session, the name does not matter";
  map.BeginSession({"room", FrameId(5)});
  map.AddKeyframe(world.Observe(10).frame, Rigid3());
  const std::vector<KeyframeImage> images = FindKeyframeImages(map, MadeSequence(), "room");
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ(images[0].frame.number, 10U);
}

TEST(KeyframeImages, OfTheSameImageHaveDifferentNames) {
  const SyntheticWorld world;
  Map map;
  map.AddKeyframe(world.Observe(10).frame, Rigid3());
  auto again = std::make_shared<Frame>(*world.Observe(10).frame);
  again->id = FrameId(11);
  map.AddKeyframe(again, Rigid3());
  const std::vector<KeyframeImage> images = FindKeyframeImages(map, MadeSequence(), "desk");
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[0].name, "frame_10");
  EXPECT_EQ(images[1].name, "frame_10_1");
}

}  // namespace
}  // namespace hullslam

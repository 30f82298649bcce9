// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "map/keyframe_graph.h"
#include "map/made_map.h"

namespace hullslam {
namespace {

std::vector<KeyframeId> KeyframeIds(const std::vector<uint32_t>& numbers) {
  std::vector<KeyframeId> ids;
  for (const uint32_t number : numbers) {
    ids.emplace_back(number);
  }
  return ids;
}

// Keyframes in a row, each sharing 20 landmarks with the next and 16 with the one after it.
Map MakeChain(uint32_t length) {
  Map map;
  for (uint32_t i = 0; i < length; ++i) {
    AddKeyframe(map, 100);
    if (i >= 1) {
      Share(map, KeyframeIds({i - 1, i}), 20);
    }
    if (i >= 2) {
      Share(map, KeyframeIds({i - 2, i}), 16);
    }
    UpdateCovisibility(map, KeyframeId(i));
  }
  return map;
}

TEST(LocalWindow, MovesTheNeighboursAndFixesOtherObservers) {
  const Map map = MakeChain(10);
  const BundleWindow window = LocalWindow(map, KeyframeId(9), 20, 40);
  EXPECT_EQ(window.moving, KeyframeIds({7, 8, 9}));
  EXPECT_EQ(window.fixed, KeyframeIds({5, 6}));
  // Each of the three shares 20 + 16 landmarks with older keyframes; none is counted twice.
  EXPECT_EQ(window.landmarks.size(), 3u * 36u);
  EXPECT_TRUE(std::is_sorted(window.landmarks.begin(), window.landmarks.end()));
}

TEST(LocalWindow, RootNeverMoves) {
  const Map map = MakeChain(10);
  const BundleWindow window = LocalWindow(map, KeyframeId(1), 20, 40);
  EXPECT_EQ(window.moving, KeyframeIds({1, 2, 3}));
  EXPECT_EQ(window.fixed, KeyframeIds({0, 4, 5}));
  const BundleWindow at_root = LocalWindow(map, KeyframeId(0), 20, 40);
  EXPECT_EQ(at_root.moving, KeyframeIds({1, 2}));
  EXPECT_EQ(at_root.fixed, KeyframeIds({0, 3, 4}));
}

TEST(LocalWindow, IsLimitedToTheKeyframesThatShareMost) {
  const Map map = MakeChain(10);
  const BundleWindow two = LocalWindow(map, KeyframeId(9), 2, 40);
  EXPECT_EQ(two.moving, KeyframeIds({8, 9}));  // 8 shares 20, 7 only 16
  EXPECT_EQ(two.fixed, KeyframeIds({6, 7}));
  const BundleWindow one_fixed = LocalWindow(map, KeyframeId(9), 2, 1);
  EXPECT_EQ(one_fixed.fixed, KeyframeIds({7}));  // it has 36 observations, 6 has 16
  EXPECT_EQ(LocalWindow(map, KeyframeId(9), 1, 40).moving, KeyframeIds({9}));
}

TEST(LocalWindow, AKeyframeIsAlwaysFixed) {
  Map map = MakeChain(1);
  EXPECT_EQ(LocalWindow(map, KeyframeId(0), 20, 40).fixed, KeyframeIds({0}));
  EXPECT_TRUE(LocalWindow(map, KeyframeId(0), 20, 40).moving.empty());
  // Two more keyframes, which share no landmark with the root.
  for (uint32_t i = 0; i < 2; ++i) {
    SetParent(map, AddKeyframe(map, 50), KeyframeId(i));
  }
  Share(map, KeyframeIds({1, 2}), 20);
  UpdateCovisibility(map, KeyframeId(2));
  const BundleWindow window = LocalWindow(map, KeyframeId(2), 20, 40);
  EXPECT_EQ(window.moving, KeyframeIds({2}));
  EXPECT_EQ(window.fixed, KeyframeIds({1}));
}

// Each of 60 keyframes shares landmarks with the last one. Without their observations, the
// landmarks would move away from where these keyframes saw them.
TEST(LocalWindow, WithoutALimitAllObserversAreFixed) {
  Map map;
  for (uint32_t i = 0; i < 60; ++i) {
    AddKeyframe(map, 1000);
  }
  for (uint32_t i = 0; i < 59; ++i) {
    Share(map, KeyframeIds({i, 59}), 15);
    UpdateCovisibility(map, KeyframeId(i));
    if (i > 0) {
      SetParent(map, KeyframeId(i), KeyframeId(0));
    }
  }
  UpdateCovisibility(map, KeyframeId(59));
  const BundleWindow window = LocalWindow(map, KeyframeId(59), 20, 0);
  EXPECT_EQ(window.moving.size(), 20u);
  EXPECT_EQ(window.fixed.size(), 40u);
  EXPECT_EQ(LocalWindow(map, KeyframeId(59), 20, 30).fixed.size(), 30u);
}

// Keyframes 0 to 9 and 10 to 13 share no landmarks but for a few that may be wrong.
TEST(Windows, DoNotMoveAKeyframeThatIsTied) {
  Map map = MakeChain(10);
  for (uint32_t i = 10; i < 14; ++i) {
    AddKeyframe(map, 100);
    Share(map, KeyframeIds({i - 1, i}), i == 10 ? 5 : 20);
    UpdateCovisibility(map, KeyframeId(i));
  }
  EXPECT_EQ(GlobalWindow(map, IslandId(0)).fixed, KeyframeIds({0, 10}));
  const BundleWindow window = LocalWindow(map, KeyframeId(10), 20, 40);
  EXPECT_EQ(std::ranges::count(window.moving, KeyframeId(10)), 0);
  EXPECT_EQ(std::ranges::count(window.fixed, KeyframeId(10)), 1);
  EXPECT_TRUE(std::ranges::is_sorted(window.fixed));
}

TEST(GlobalWindow, MovesAllButTheRoot) {
  const Map map = MakeChain(5);
  const BundleWindow window = GlobalWindow(map, IslandId(0));
  EXPECT_EQ(window.moving, KeyframeIds({1, 2, 3, 4}));
  EXPECT_EQ(window.fixed, KeyframeIds({0}));
  EXPECT_EQ(window.landmarks.size(), 4u * 20u + 3u * 16u);
  EXPECT_TRUE(std::is_sorted(window.landmarks.begin(), window.landmarks.end()));
  EXPECT_TRUE(window.objects.empty());
}

TEST(ObjectsToAdjust, AreTheMappedObjectsIfTheOptionIsSet) {
  ObjectOptions options;
  options.enabled = true;
  EXPECT_EQ(ObjectsToAdjust(options), WindowObjects::kMapped);
  options.bundle_adjustment = false;
  EXPECT_EQ(ObjectsToAdjust(options), WindowObjects::kNone);
  options.bundle_adjustment = true;
  options.enabled = false;
  EXPECT_EQ(ObjectsToAdjust(options), WindowObjects::kNone);
}

// In a star of keyframes that see the first one only, the first one must be among the last two.
TEST(SortForElimination, AKeyframeWithManyNeighboursComesLate) {
  Map map;
  BundleWindow window;
  for (uint32_t i = 0; i < 8; ++i) {
    auto frame = std::make_shared<Frame>();
    frame->id = FrameId(i);
    window.moving.push_back(map.AddKeyframe(frame, Rigid3(), IslandId(0)));
  }
  for (uint32_t i = 1; i < 8; ++i) {
    map.MutableKeyframe(KeyframeId(0)).covisible.push_back({KeyframeId(i), 20});
    map.MutableKeyframe(KeyframeId(i)).covisible.push_back({KeyframeId(0), 20});
  }
  map.MutableKeyframe(KeyframeId(3)).covisible.push_back({KeyframeId(99), 20});  // elsewhere
  const std::vector<KeyframeId> before = window.moving;
  SortForElimination(map, window);
  EXPECT_TRUE(std::ranges::is_permutation(window.moving, before));
  EXPECT_GE(std::ranges::find(window.moving, KeyframeId(0)) - window.moving.begin(), 6);
}

}  // namespace
}  // namespace hullslam

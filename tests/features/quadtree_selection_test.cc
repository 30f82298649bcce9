// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/quadtree_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

namespace hullslam {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

// Distinct pixels with random scores; a share of `share` lies in one corner of the image.
std::vector<Corner> MakeCorners(size_t count, double share) {
  std::mt19937 random(5);
  std::set<std::tuple<int, int>> taken;
  std::vector<Corner> corners;
  while (corners.size() < count) {
    const bool crowded = static_cast<double>(corners.size()) < share * static_cast<double>(count);
    const int x = static_cast<int>(random() % (crowded ? 80 : kWidth));
    const int y = static_cast<int>(random() % (crowded ? 60 : kHeight));
    if (taken.emplace(y, x).second) {
      corners.push_back({static_cast<int16_t>(x), static_cast<int16_t>(y),
                         static_cast<int16_t>(7 + random() % 100)});
    }
  }
  return corners;
}

std::tuple<int, int, int> Key(const Corner& corner) { return {corner.y, corner.x, corner.score}; }

std::vector<Corner> Select(std::vector<Corner> corners, size_t count) {
  std::vector<Corner> selected;
  QuadtreeSelection().Select(corners, {kWidth, kHeight}, count, selected);
  return selected;
}

TEST(QuadtreeSelection, SelectsTheWantedNumberInRasterOrder) {
  const std::vector<Corner> corners = MakeCorners(3000, 0.5);
  std::set<std::tuple<int, int, int>> offered;
  for (const Corner& corner : corners) {
    offered.insert(Key(corner));
  }
  for (const size_t count : {1u, 2u, 10u, 217u, 1000u, 2999u}) {
    const std::vector<Corner> selected = Select(corners, count);
    EXPECT_GE(selected.size(), count);
    EXPECT_LE(selected.size(), count + 2);
    for (size_t i = 0; i < selected.size(); ++i) {
      EXPECT_TRUE(offered.contains(Key(selected[i])));
      if (i > 0) {
        EXPECT_LT(Key(selected[i - 1]),
                  Key(selected[i]));  // so no corner is selected more than once
      }
    }
  }
}

TEST(QuadtreeSelection, SelectsAllIfThereAreAtMostThatMany) {
  const std::vector<Corner> corners = MakeCorners(50, 0.0);
  EXPECT_EQ(Select(corners, 50).size(), 50u);
  EXPECT_EQ(Select(corners, 51).size(), 50u);
  EXPECT_TRUE(Select({}, 10).empty());
  EXPECT_TRUE(Select({}, 0).empty());
}

TEST(QuadtreeSelection, SelectsTheStrongest) {
  const std::vector<Corner> corners = {{10, 10, 30}, {20, 12, 50}, {200, 100, 40}};
  const std::vector<Corner> one = Select(corners, 1);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].score, 50);
}

TEST(QuadtreeSelection, SelectsFromEachQuarterFirst) {
  const std::vector<Corner> corners = {{10, 10, 90}, {14, 10, 80}, {600, 10, 8},
                                       {12, 14, 70}, {10, 400, 9}, {610, 470, 10}};
  const std::vector<Corner> four = Select(corners, 4);
  ASSERT_EQ(four.size(), 4u);
  EXPECT_EQ(four[0].score, 90);
  EXPECT_EQ(four[1].score, 8);
  EXPECT_EQ(four[2].score, 9);
  EXPECT_EQ(four[3].score, 10);
}

// Nine of ten corners are crowded in a fiftieth of the image; only few of the selected corners may
// be there.
TEST(QuadtreeSelection, SpreadsCrowdedCorners) {
  const std::vector<Corner> selected = Select(MakeCorners(3000, 0.9), 200);
  const auto crowded = std::count_if(selected.begin(), selected.end(), [](const Corner& corner) {
    return corner.x < 80 && corner.y < 60;
  });
  EXPECT_LT(static_cast<double>(crowded), 0.2 * static_cast<double>(selected.size()));
}

TEST(QuadtreeSelection, DoesNotDependOnEarlierCalls) {
  const std::vector<Corner> corners = MakeCorners(2000, 0.3);
  QuadtreeSelection selection;
  std::vector<Corner> first;
  std::vector<Corner> again;
  std::vector<Corner> input = corners;
  selection.Select(input, {kWidth, kHeight}, 300, first);
  input = MakeCorners(500, 0.1);
  selection.Select(input, {kWidth, kHeight}, 20, again);
  input = corners;
  selection.Select(input, {kWidth, kHeight}, 300, again);
  EXPECT_TRUE(std::ranges::equal(first, again, {}, Key, Key));
}

}  // namespace
}  // namespace hullslam

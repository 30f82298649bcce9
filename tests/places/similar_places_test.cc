// SPDX-License-Identifier: GPL-3.0-or-later
#include "places/similar_places.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "places/made_places.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

using Ids = std::vector<KeyframeId>;

Ids IdsOf(const std::vector<SimilarKeyframe>& similar) {
  Ids ids;
  for (const SimilarKeyframe& one : similar) {
    ids.push_back(one.keyframe);
  }
  return ids;
}

// A map with the keyframes 0 to count - 1, which share neither words nor landmarks.
Map MakeStrangers(uint32_t count) {
  Map map = MakeWordMap();
  for (uint32_t i = 0; i < count; ++i) {
    AddWords(map, {i});
  }
  return map;
}

TEST(PlaceOf, IsTheKeyframeAndTheTenThatShareMostLandmarksWithIt) {
  Map map = MakeStrangers(14);
  EXPECT_EQ(PlaceOf(map, KeyframeId(5)), Ids{KeyframeId(5)});
  const auto hub = AddWords(map, {0}, 400);
  for (uint32_t i = 0; i < 14; ++i) {
    Connect(map, KeyframeId(i), hub, i == 3 ? 15 : 16 + static_cast<int>(i));
  }
  const Ids place = PlaceOf(map, hub);
  EXPECT_EQ(place.size(), 11u) << "ten neighbours and itself";
  EXPECT_TRUE(std::is_sorted(place.begin(), place.end()));
  EXPECT_EQ(place.front(), KeyframeId(4)) << "0 to 3 share less than the others";
  EXPECT_EQ(place.back(), hub);
}

TEST(KeepMostCommon, KeepsFourFifthsOfTheBestInTheirOrder) {
  std::vector<SimilarKeyframe> similar = {{KeyframeId(7), 8, 0.5},
                                          {KeyframeId(1), 7, 0.4},
                                          {KeyframeId(4), 10, 0.3},
                                          {KeyframeId(2), 9, 0.2}};
  KeepMostCommon(similar);
  EXPECT_EQ(IdsOf(similar), (Ids{KeyframeId(7), KeyframeId(4), KeyframeId(2)}));
  std::vector<SimilarKeyframe> none;
  KeepMostCommon(none);
  EXPECT_TRUE(none.empty());
}

TEST(KeepMostCommon, TheBestStays) {
  RandomGeometry random(1);
  for (int run = 0; run < 100; ++run) {
    std::vector<SimilarKeyframe> similar;
    for (uint32_t i = 0; i < 20; ++i) {
      similar.push_back({KeyframeId(i), 1 + random.Index(50), random.Number(0.0, 1.0)});
    }
    const auto fewer = [](const SimilarKeyframe& a, const SimilarKeyframe& b) {
      return a.common_words < b.common_words;
    };
    const uint32_t most = std::max_element(similar.begin(), similar.end(), fewer)->common_words;
    KeepMostCommon(similar);
    ASSERT_FALSE(similar.empty());
    EXPECT_EQ(std::max_element(similar.begin(), similar.end(), fewer)->common_words, most);
    EXPECT_GE(std::min_element(similar.begin(), similar.end(), fewer)->common_words, 0.8 * most);
  }
}

TEST(BestOfPlaces, ListsOneKeyframePerPlaceInTheOrderOfSimilarity) {
  Map map = MakeStrangers(5);
  Connect(map, KeyframeId(0), KeyframeId(1));
  Connect(map, KeyframeId(2), KeyframeId(3));
  EXPECT_EQ(BestOfPlaces(map, {{KeyframeId(3), 5, 0.50},
                               {KeyframeId(1), 5, 0.45},
                               {KeyframeId(0), 5, 0.40},
                               {KeyframeId(2), 5, 0.30}}),
            (Ids{KeyframeId(3), KeyframeId(1)}));
  EXPECT_TRUE(BestOfPlaces(map, {}).empty());
}

// A place that several keyframes show counts more than a single one that looks alike by chance.
TEST(BestOfPlaces, TheScoresOfAPlaceAreAddedUp) {
  Map map = MakeStrangers(5);
  Connect(map, KeyframeId(0), KeyframeId(1));
  const auto best = [&](double of_stranger) {
    return BestOfPlaces(
        map, {{KeyframeId(4), 5, of_stranger}, {KeyframeId(0), 5, 0.40}, {KeyframeId(1), 5, 0.40}});
  };
  EXPECT_EQ(best(0.59), Ids{KeyframeId(0)}) << "three quarters of the best sum are 0.6";
  EXPECT_EQ(best(0.61), (Ids{KeyframeId(4), KeyframeId(0)}));
}

// A neighbour that does not look like the image adds nothing.
TEST(BestOfPlaces, OnlySimilarKeyframesAddToAPlace) {
  Map map = MakeStrangers(5);
  Connect(map, KeyframeId(0), KeyframeId(1));
  Connect(map, KeyframeId(2), KeyframeId(3));
  EXPECT_EQ(BestOfPlaces(map, {{KeyframeId(0), 5, 0.40}, {KeyframeId(2), 5, 0.29}}),
            Ids{KeyframeId(0)});
  EXPECT_EQ(BestOfPlaces(
                map, {{KeyframeId(0), 5, 0.40}, {KeyframeId(2), 5, 0.29}, {KeyframeId(3), 5, 0.2}}),
            (Ids{KeyframeId(0), KeyframeId(2)}));
}

}  // namespace
}  // namespace hullslam

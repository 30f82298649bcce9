// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/local_map_tracking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "map/keyframe_graph.h"
#include "map/made_map.h"

namespace hullslam {
namespace {

constexpr size_t kKeypoints = 50;

// Keyframes with free keypoints only. The tests add observations one by one.
class PlantedMap {
 public:
  explicit PlantedMap(int keyframes) {
    for (int i = 0; i < keyframes; ++i) {
      auto frame = std::make_shared<Frame>();
      frame->id = FrameId(static_cast<uint32_t>(i));
      frame->features.keypoints.resize(kKeypoints);
      frame->features.descriptors.resize(kKeypoints);
      frame->features.depth.assign(kKeypoints, 1.0f);
      map.AddKeyframe(std::move(frame), Rigid3());
      used_.push_back(0);
    }
  }

  LandmarkId AddLandmark(const std::vector<uint32_t>& observers) {
    const LandmarkId id = map.AddLandmark(Eigen::Vector3d::Zero(), KeyframeId(observers.front()));
    for (const uint32_t keyframe : observers) {
      EXPECT_TRUE(map.AddObservation(id, KeyframeId(keyframe), used_[keyframe]++));
    }
    return id;
  }

  void AddEdge(uint32_t a, uint32_t b, int shared) {
    AddHalfEdge(a, b, shared);
    AddHalfEdge(b, a, shared);
  }

  Map map;

 private:
  void AddHalfEdge(uint32_t from, uint32_t to, int shared) {
    auto& edges = map.MutableKeyframe(KeyframeId(from)).covisible;
    const auto position =
        std::upper_bound(edges.begin(), edges.end(), KeyframeId(to),
                         [](KeyframeId id, const Covisible& edge) { return id < edge.keyframe; });
    edges.insert(position, {KeyframeId(to), shared});
  }

  std::vector<uint32_t> used_;  // number of used keypoints of each keyframe
};

TEST(LocalMap, WithoutLandmarksItSurroundsTheLastReference) {
  PlantedMap planted(4);
  const LandmarkId a = planted.AddLandmark({0, 1});
  const LandmarkId b = planted.AddLandmark({2});
  planted.AddLandmark({3});
  planted.AddEdge(1, 2, 20);
  const LocalMap local = SelectLocalMap(planted.map, {}, KeyframeId(1), 10);
  EXPECT_EQ(local.reference, KeyframeId(1));
  EXPECT_EQ(local.keyframes, KeyframeIds({1, 2}));
  EXPECT_EQ(local.landmarks, (std::vector{a, b}));
}

TEST(LocalMap, TheReferenceSharesMostLandmarks) {
  PlantedMap planted(4);
  const LandmarkId a = planted.AddLandmark({0, 2});
  const LandmarkId b = planted.AddLandmark({2, 3});
  const LandmarkId c = planted.AddLandmark({2, 3});
  const LocalMap local = SelectLocalMap(planted.map, std::vector{a, b, c}, KeyframeId(1), 10);
  EXPECT_EQ(local.reference, KeyframeId(2));
  EXPECT_EQ(local.keyframes, KeyframeIds({0, 2, 3})) << "keyframe 1 observes none of them";
}

TEST(LocalMap, ATieGoesToTheOldestKeyframe) {
  PlantedMap planted(3);
  const LandmarkId a = planted.AddLandmark({1, 2});
  EXPECT_EQ(SelectLocalMap(planted.map, std::vector{a}, KeyframeId(0), 10).reference,
            KeyframeId(1));
}

TEST(LocalMap, ContainsAllLandmarksOfItsKeyframesOnceAndInOrder) {
  PlantedMap planted(3);
  const LandmarkId a = planted.AddLandmark({0, 1});
  const LandmarkId elsewhere = planted.AddLandmark({2});
  const LandmarkId b = planted.AddLandmark({1});
  const LandmarkId c = planted.AddLandmark({0});
  const LocalMap local = SelectLocalMap(planted.map, std::vector{a}, KeyframeId(0), 10);
  EXPECT_EQ(local.landmarks, (std::vector{a, b, c}));
  EXPECT_NE(elsewhere, a);
}

TEST(LocalMap, InvalidAndErasedLandmarksHaveNoVote) {
  PlantedMap planted(2);
  const LandmarkId a = planted.AddLandmark({0});
  const LandmarkId erased = planted.AddLandmark({1});
  planted.map.EraseLandmark(erased);
  const LocalMap local =
      SelectLocalMap(planted.map, std::vector{LandmarkId(), a, erased}, KeyframeId(0), 10);
  EXPECT_EQ(local.keyframes, KeyframeIds({0}));
  EXPECT_EQ(local.landmarks, std::vector{a});
}

TEST(LocalMap, ContainsNeighboursInCovisibilityAndTree) {
  PlantedMap planted(6);
  const LandmarkId a = planted.AddLandmark({2});
  planted.AddEdge(2, 4, 20);
  SetParent(planted.map, KeyframeId(2), KeyframeId(0));
  SetParent(planted.map, KeyframeId(5), KeyframeId(2));
  SetParent(planted.map, KeyframeId(1), KeyframeId(0));
  planted.AddEdge(4, 3, 20);
  const LocalMap local = SelectLocalMap(planted.map, std::vector{a}, KeyframeId(0), 10);
  EXPECT_EQ(local.keyframes, KeyframeIds({0, 2, 4, 5})) << "neighbours of neighbours are not added";
}

TEST(LocalMap, ContainsOnlyTheTenBestNeighbours) {
  PlantedMap planted(13);
  const LandmarkId a = planted.AddLandmark({0});
  for (uint32_t i = 1; i <= 12; ++i) {
    planted.AddEdge(0, i, 100 + static_cast<int>(i));
  }
  const LocalMap local = SelectLocalMap(planted.map, std::vector{a}, KeyframeId(0), 80);
  EXPECT_EQ(local.keyframes, KeyframeIds({0, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
}

TEST(LocalMap, TheLimitKeepsTheKeyframesThatShareMost) {
  PlantedMap planted(5);
  std::vector<LandmarkId> landmarks;
  for (int i = 0; i < 3; ++i) {
    landmarks.push_back(planted.AddLandmark({4}));
  }
  for (int i = 0; i < 2; ++i) {
    landmarks.push_back(planted.AddLandmark({1}));
  }
  landmarks.push_back(planted.AddLandmark({0}));
  planted.AddEdge(4, 3, 90);
  const LocalMap two = SelectLocalMap(planted.map, landmarks, KeyframeId(0), 2);
  EXPECT_EQ(two.reference, KeyframeId(4));
  EXPECT_EQ(two.keyframes, KeyframeIds({1, 4}));
  EXPECT_EQ(SelectLocalMap(planted.map, landmarks, KeyframeId(0), 3).keyframes,
            KeyframeIds({0, 1, 4}));
  EXPECT_EQ(SelectLocalMap(planted.map, landmarks, KeyframeId(0), 4).keyframes,
            KeyframeIds({0, 1, 3, 4}));
}

}  // namespace

}  // namespace hullslam

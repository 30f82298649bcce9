// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/landmark_edits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "map/made_map.h"

namespace hullslam {
namespace {

// A descriptor with the first `count` bits set.
Descriptor FirstBits(int count) {
  Descriptor descriptor{};
  for (int i = 0; i < count; ++i) {
    descriptor[static_cast<size_t>(i / 64)] |= uint64_t{1} << (i % 64);
  }
  return descriptor;
}

size_t MostTypicalOf(const std::vector<int>& counts) {
  std::vector<Descriptor> descriptors;
  for (const int count : counts) {
    descriptors.push_back(FirstBits(count));
  }
  return MostTypicalDescriptor(descriptors);
}

TEST(MostTypicalDescriptor, HasTheLeastMedianDistanceToTheOthers) {
  EXPECT_EQ(MostTypicalOf({0, 10, 12, 14, 100}), 2u);
  EXPECT_EQ(MostTypicalOf({200, 10, 11}), 1u);
}

TEST(MostTypicalDescriptor, TiesGoToTheFirst) {
  EXPECT_EQ(MostTypicalOf({5, 9}), 0u);
  EXPECT_EQ(MostTypicalOf({3, 3, 3}), 0u);
  EXPECT_EQ(MostTypicalOf({}), 0u);
}

// The descriptor chosen for a landmark whose observations have these descriptors.
Descriptor Chosen(const std::vector<Descriptor>& descriptors) {
  Map map;
  const LandmarkId landmark = map.AddLandmark({0.0, 0.0, 2.0}, KeyframeId(0));
  for (uint32_t i = 0; i < descriptors.size(); ++i) {
    const std::shared_ptr<Frame> frame = MakeFrame(i, 3);
    frame->features.descriptors[1] = descriptors[i];
    map.AddObservation(landmark, map.AddKeyframe(frame, {}), 1);
  }
  UpdateDescriptor(map, landmark);
  return map.landmarks().At(landmark).descriptor;
}

TEST(UpdateDescriptor, ByHand) {
  EXPECT_EQ(Chosen({FirstBits(7)}), FirstBits(7));
  // The descriptor of 12 bits has distances 12, 2, 2 and 88 to the others: the smallest median.
  EXPECT_EQ(Chosen({FirstBits(0), FirstBits(10), FirstBits(12), FirstBits(14), FirstBits(100)}),
            FirstBits(12));
  EXPECT_EQ(Chosen({FirstBits(200), FirstBits(10), FirstBits(11)}), FirstBits(10));
}

TEST(UpdateDescriptor, HasTheSmallestMedianDistance) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 20; ++round) {
    std::vector<Descriptor> all;
    for (size_t i = 0; i < 3 + random() % 9; ++i) {
      all.push_back({random(), random(), random(), random()});
    }
    const auto median = [&](const Descriptor& descriptor) {
      std::vector<int> distances;
      for (const Descriptor& other : all) {
        distances.push_back(HammingDistance(descriptor, other));
      }
      std::sort(distances.begin(), distances.end());
      return distances[(distances.size() - 1) / 2];
    };
    const int chosen = median(Chosen(all));
    for (const Descriptor& descriptor : all) {
      EXPECT_LE(chosen, median(descriptor));
    }
  }
}

TEST(UpdateDescriptor, WithoutObservationsChangesNothing) {
  Map map;
  const KeyframeId keyframe = AddKeyframe(map, 1);
  const LandmarkId landmark = map.AddLandmark({}, keyframe);
  map.MutableLandmark(landmark).descriptor = FirstBits(9);
  UpdateDescriptor(map, landmark);
  UpdateViewingGeometry(map, landmark, ScaleLevels::Create(8, 1.2));
  EXPECT_EQ(map.landmarks().At(landmark).descriptor, FirstBits(9));
  EXPECT_EQ(map.landmarks().At(landmark).max_distance, 0.0);
}

// A landmark at (0, 0, 2) seen by cameras at (1, 0, 0), at level 2, and at (-1, 0, 0), at level 0.
class ViewingGeometry : public ::testing::Test {
 protected:
  ViewingGeometry() {
    for (const double x : {1.0, -1.0}) {
      const std::shared_ptr<Frame> frame = MakeFrame(map_.keyframes().NextId().value, 1);
      frame->features.keypoints[0].level = x > 0.0 ? 2 : 0;
      map_.AddKeyframe(frame, {Eigen::Quaterniond::Identity(), {-x, 0.0, 0.0}});
    }
    landmark_ = map_.AddLandmark({0.0, 0.0, 2.0}, KeyframeId(0));
    map_.AddObservation(landmark_, KeyframeId(0), 0);
    map_.AddObservation(landmark_, KeyframeId(1), 0);
  }
  const Landmark& Updated() {
    UpdateViewingGeometry(map_, landmark_, levels_);
    return map_.landmarks().At(landmark_);
  }

  const ScaleLevels levels_ = ScaleLevels::Create(8, 1.2);
  Map map_;
  LandmarkId landmark_;
};

TEST_F(ViewingGeometry, ByHand) {
  const Landmark& landmark = Updated();
  EXPECT_LT((landmark.viewing_direction - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  // From sqrt(5) m it is seen at level 2, so from 1.44 times as far at level 0.
  EXPECT_NEAR(landmark.max_distance, 1.44 * std::sqrt(5.0), 1e-6);
  EXPECT_NEAR(landmark.min_distance, 1.44 * std::sqrt(5.0) / std::pow(1.2, 7), 1e-6);
}

TEST_F(ViewingGeometry, ComesFromTheReferenceOrElseFromTheFirstObserver) {
  map_.MutableLandmark(landmark_).reference = KeyframeId(1);
  EXPECT_NEAR(Updated().max_distance, std::sqrt(5.0), 1e-6);
  map_.MutableLandmark(landmark_).reference = KeyframeId(77);
  EXPECT_NEAR(Updated().max_distance, 1.44 * std::sqrt(5.0), 1e-6);
}

TEST_F(ViewingGeometry, DirectionIsTheMeanOfUnitVectors) {
  map_.SetPose(KeyframeId(1), {Eigen::Quaterniond::Identity(), {0.0, 0.0, -1.99}});
  // A camera 1 cm away counts as much as a distant one.
  const Eigen::Vector3d expected =
      (Eigen::Vector3d::UnitZ() + Eigen::Vector3d(-1.0, 0.0, 2.0).normalized()).normalized();
  EXPECT_LT((Updated().viewing_direction - expected).norm(), 1e-12);
}

}  // namespace

}  // namespace hullslam

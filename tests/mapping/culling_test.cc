// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/culling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "map/invariants.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// Keyframes with many keypoints with depth, which can observe landmarks.
class RecentLandmarksTest : public testing::Test {
 protected:
  RecentLandmarksTest() {
    for (uint32_t i = 0; i < 5; ++i) {
      map_.AddKeyframe(world_.Observe(i).frame, SyntheticWorld::CamFromWorld(i));
    }
  }

  // Adds a landmark that keyframe `by` made and that `observers` keyframes from `by` on observe.
  LandmarkId Add(uint32_t by, uint32_t observers, int visible, int found) {
    const LandmarkId id = map_.AddLandmark(Eigen::Vector3d(0.0, 0.0, 3.0), KeyframeId(by));
    for (uint32_t i = 0; i < observers; ++i) {
      EXPECT_TRUE(map_.AddObservation(id, KeyframeId(by + i), next_keypoint_));
    }
    ++next_keypoint_;
    map_.CountSightings(id, visible - 1, found - 1);
    return id;
  }

  void ExpectCulled(LandmarkId id, uint32_t current, const std::string& what) {
    std::vector<LandmarkId> recent = {id};
    CullRecentLandmarks(map_, KeyframeId(current), recent);
    EXPECT_FALSE(map_.landmarks().Contains(id)) << what;
    EXPECT_TRUE(recent.empty()) << what;
    EXPECT_EQ(FindViolations(map_), std::vector<std::string>());
  }
  void ExpectKept(LandmarkId id, uint32_t current, bool on_trial, const std::string& what) {
    std::vector<LandmarkId> recent = {id};
    CullRecentLandmarks(map_, KeyframeId(current), recent);
    EXPECT_TRUE(map_.landmarks().Contains(id)) << what;
    EXPECT_EQ(recent.size(), on_trial ? 1u : 0u) << what;
  }

  const SyntheticWorld world_{{.points = 300}};
  Map map_;
  uint32_t next_keypoint_ = 0;
};

TEST_F(RecentLandmarksTest, AreErasedIfFoundInLessThanAQuarterOfTheFrames) {
  ExpectKept(Add(0, 3, 100, 25), 1, true, "exactly a quarter");
  ExpectCulled(Add(0, 3, 100, 24), 1, "below a quarter");
  ExpectCulled(Add(0, 3, 100, 24), 4, "below a quarter, old");
}

TEST_F(RecentLandmarksTest, AreErasedIfTheirWeightIsSmallAfterTwoKeyframes) {
  ExpectKept(Add(1, 1, 1, 1), 2, true, "one observation, one keyframe later");
  ExpectCulled(Add(1, 1, 1, 1), 3, "one observation with depth, two keyframes later");
  ExpectKept(Add(1, 2, 1, 1), 3, true, "two observations with depth are enough");
}

TEST_F(RecentLandmarksTest, LeaveTheListAfterThreeKeyframes) {
  ExpectKept(Add(1, 2, 1, 1), 3, true, "two keyframes later");
  ExpectKept(Add(1, 2, 1, 1), 4, false, "three keyframes later");
}

TEST_F(RecentLandmarksTest, ThatNoLongerExistLeaveTheList) {
  const LandmarkId gone = Add(0, 2, 1, 1);
  const LandmarkId replaced = Add(0, 2, 1, 1);
  const LandmarkId by = Add(0, 2, 1, 1);
  map_.EraseLandmark(gone);
  map_.ReplaceLandmark(replaced, by);
  std::vector<LandmarkId> recent = {gone, replaced, by};
  CullRecentLandmarks(map_, KeyframeId(0), recent);
  EXPECT_EQ(recent, std::vector{by});
}

// Keyframes so close together that they see the same points at the same levels.
SyntheticMap NearbyKeyframes(const SyntheticWorld& world, uint32_t count) {
  SyntheticMap made;
  std::vector<LandmarkId>& landmarks = made.landmarks;
  landmarks.resize(world.points().size());
  for (uint32_t i = 0; i < count; ++i) {
    const SyntheticView view = world.Observe(FrameId(i), Rigid3());
    const KeyframeId id = made.map.AddKeyframe(view.frame, Rigid3());
    for (uint32_t k = 0; k < view.points.size(); ++k) {
      LandmarkId& landmark = landmarks[view.points[k]];
      if (!landmark.IsValid()) {
        landmark = made.map.AddLandmark(world.points()[view.points[k]], id);
      }
      made.map.AddObservation(landmark, id, k);
    }
    UpdateCovisibility(made.map, id);
    made.views.push_back(view);
  }
  return made;
}

TEST(CullKeyframes, RemovesKeyframesWhileThreeOthersSeeTheirLandmarks) {
  const SyntheticWorld world;
  SyntheticMap made = NearbyKeyframes(world, 5);
  const auto landmarks = made.map.landmarks().size();
  EXPECT_EQ(CullKeyframes(made.map, KeyframeId(4), world.sensor()), 2);
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  EXPECT_FALSE(made.map.keyframes().Contains(KeyframeId(1)));
  EXPECT_FALSE(made.map.keyframes().Contains(KeyframeId(2)));
  EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(3))) << "two others are left";
  EXPECT_EQ(made.map.landmarks().size(), landmarks) << "no landmark is erased with it";
}

TEST(CullKeyframes, KeepsTheRootAndTheCurrentKeyframe) {
  const SyntheticWorld world;
  SyntheticMap made = NearbyKeyframes(world, 8);
  EXPECT_EQ(CullKeyframes(made.map, KeyframeId(7), world.sensor()), 5);
  EXPECT_EQ(FindViolations(made.map), std::vector<std::string>());
  EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(0)));
  EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(7)));
}

TEST(CullKeyframes, RemovesNoneOfThreeKeyframes) {
  const SyntheticWorld world;
  SyntheticMap made = NearbyKeyframes(world, 3);
  EXPECT_EQ(CullKeyframes(made.map, KeyframeId(2), world.sensor()), 0);
}

TEST(CullKeyframes, OnlyCloseLandmarksCount) {
  const SyntheticWorld world;
  SyntheticMap made = NearbyKeyframes(world, 6);
  Sensor sensor = world.sensor();
  sensor.close_depth = 0.5;
  EXPECT_EQ(CullKeyframes(made.map, KeyframeId(5), sensor), 0) << "none is close";
}

TEST(CullKeyframes, MoreThanNineTenthsMustBeSeenByOthers) {
  const SyntheticWorld world;
  const auto is_culled_with_share_alone = [&](double share) {
    SyntheticMap made = NearbyKeyframes(world, 5);
    const Keyframe keyframe = made.map.keyframes().At(KeyframeId(1));
    const std::vector<float>& depth = keyframe.frame->features.depth;
    std::vector<LandmarkId> close;
    for (size_t i = 0; i < depth.size(); ++i) {
      if (depth[i] > 0.0f && static_cast<double>(depth[i]) <= world.sensor().close_depth) {
        close.push_back(keyframe.landmarks[i]);
      }
    }
    const auto alone = static_cast<size_t>(share * static_cast<double>(close.size()));
    for (size_t i = 0; i < alone; ++i) {  // two other keyframes still see them, too few
      made.map.RemoveObservation(close[i], KeyframeId(3));
      made.map.RemoveObservation(close[i], KeyframeId(4));
    }
    CullKeyframes(made.map, KeyframeId(4), world.sensor());
    return !made.map.keyframes().Contains(KeyframeId(1));
  };
  EXPECT_TRUE(is_culled_with_share_alone(0.08));
  EXPECT_FALSE(is_culled_with_share_alone(0.12));
}

TEST(CullKeyframes, ObserversAtACoarserLevelDoNotCount) {
  const SyntheticWorld world;
  SyntheticMap made;
  std::vector<LandmarkId> landmarks(world.points().size());
  for (uint32_t i = 0; i < 5; ++i) {
    // All others are at the same place but see every patch two levels coarser than keyframe 1.
    const SyntheticView view = world.Observe(FrameId(i), Rigid3());
    auto frame = std::make_shared<Frame>(*view.frame);
    for (Keypoint& keypoint : frame->features.keypoints) {
      keypoint.level = i == 1 ? 1 : 3;
    }
    const KeyframeId id = made.map.AddKeyframe(frame, Rigid3());
    for (uint32_t k = 0; k < view.points.size(); ++k) {
      LandmarkId& landmark = landmarks[view.points[k]];
      if (!landmark.IsValid()) {
        landmark = made.map.AddLandmark(world.points()[view.points[k]], id);
      }
      made.map.AddObservation(landmark, id, k);
    }
    UpdateCovisibility(made.map, id);
  }
  CullKeyframes(made.map, KeyframeId(4), world.sensor());
  EXPECT_TRUE(made.map.keyframes().Contains(KeyframeId(1)));
  EXPECT_FALSE(made.map.keyframes().Contains(KeyframeId(2)))
      << "keyframe 1 sees its landmarks at a finer level";
}

}  // namespace
}  // namespace hullslam

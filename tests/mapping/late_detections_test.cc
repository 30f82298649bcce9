// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/late_detections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "map_files/invariants.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

// A map of two keyframes. Some landmarks that the message knows were replaced meanwhile.
class LateDetectionsTest : public testing::Test {
 protected:
  // Replaces a landmark that both keyframes see, so that its keypoints show another landmark.
  LandmarkId Replace(LandmarkId landmark) {
    const LandmarkId by = made_.map.AddLandmark({0.0, 0.0, 3.0}, KeyframeId(0));
    made_.map.ReplaceLandmark(landmark, by);
    return by;
  }
  // The index of the first keypoint of keyframe 1 that shows a landmark.
  uint32_t FirstKeypoint() const {
    const auto& landmarks = made_.map.keyframes().At(KeyframeId(1)).landmarks;
    const auto first =
        std::ranges::find_if(landmarks, [](LandmarkId landmark) { return landmark.IsValid(); });
    return static_cast<uint32_t>(first - landmarks.begin());
  }
  LateDetections Late(uint32_t dynamic) const {
    return {.frame = FrameId(5),
            .detections = {},
            .keypoints = made_.views[1].points.size(),
            .dynamic_keypoints = {dynamic}};
  }

  const SyntheticWorld world_{{.points = 100}};
  SyntheticMap made_ = MakeSyntheticMap(world_, {0, 5});
};

TEST_F(LateDetectionsTest, TheLandmarkThatReplacedADynamicOneIsErased) {
  const uint32_t keypoint = FirstKeypoint();
  LateDetections late = Late(keypoint);
  late.request = KeyframeRequest{.frame = made_.views[1].frame,
                                 .pose = {},
                                 .landmarks = made_.map.keyframes().At(KeyframeId(1)).landmarks,
                                 .sightings = {}};
  const LandmarkId by = Replace(late.request->landmarks[keypoint]);
  ASSERT_TRUE(made_.map.landmarks().Contains(by));
  EXPECT_EQ(EraseDynamicLandmarks(made_.map, late), 1U);
  EXPECT_FALSE(made_.map.landmarks().Contains(by));
  EXPECT_EQ(EraseDynamicLandmarks(made_.map, late), 0U) << "again";
  EXPECT_EQ(FindViolations(made_.map), std::vector<std::string>());
  late.request.reset();
  EXPECT_EQ(EraseDynamicLandmarks(made_.map, late), 0U) << "a frame without a pose";
}

TEST_F(LateDetectionsTest, AKeyframeLosesTheLandmarkThatItsDynamicKeypointShows) {
  const uint32_t keypoint = FirstKeypoint();
  const LandmarkId by = Replace(made_.map.keyframes().At(KeyframeId(1)).landmarks[keypoint]);
  const size_t keypoints = made_.views[1].points.size();
  EXPECT_TRUE(AddLateDetections(made_.map, world_.sensor(), KeyframeId(1), Late(keypoint)));
  EXPECT_FALSE(made_.map.landmarks().Contains(by));
  EXPECT_EQ(made_.map.keyframes().At(KeyframeId(1)).frame->features.size(), keypoints - 1);
  EXPECT_EQ(FindViolations(made_.map), std::vector<std::string>());
}

TEST_F(LateDetectionsTest, NoKeyframeIsRequestedForAFrameWhosePlaceWasRemoved) {
  LateDetections late = Late(0);
  late.detections.resize(1);
  late.request = KeyframeRequest{.frame = made_.views[1].frame,
                                 .pose = {},  // no reference
                                 .landmarks = {},
                                 .sightings = {}};
  RequestMemory memory;
  EXPECT_FALSE(RequestLateKeyframe(made_.map, world_.sensor(), {}, late, memory));
}

}  // namespace
}  // namespace hullslam

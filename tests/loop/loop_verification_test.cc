// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_verification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "map/keyframe_graph.h"
#include "places/similar_places.h"
#include "support/made_similarity.h"
#include "support/ring_world.h"

namespace hullslam {
namespace {

// Keyframe 29 is at the place of keyframe 5.
class LoopVerification : public testing::Test {
 protected:
  LoopVerdict Verify(const RingMap& made, uint32_t query = 29, uint32_t candidate = 5,
                     uint64_t seed = 1) const {
    return VerifyLoop(made.map, world_.sensor(), KeyframeId(query), KeyframeId(candidate), true,
                      seed, options_);
  }
  static Sim3 Truth(const RingMap& made, uint32_t query, uint32_t candidate) {
    return Sim3(made.true_cam_from_world[query] * Inverse(made.true_cam_from_world[candidate]));
  }

  const RingWorld& world_ = SharedRing();
  RingMap made_ = MakeRingMap(world_);
  LoopOptions options_;
};

TEST_F(LoopVerification, FindsTheTrueMotionBetweenTheEnds) {
  // The motion is also found if the viewing directions differ by 15 degrees.
  for (const uint32_t candidate : {4u, 5u, 6u}) {
    const LoopVerdict verdict = Verify(made_, 29, candidate);
    ASSERT_TRUE(verdict.loop) << candidate << ": " << verdict.refusal;
    EXPECT_EQ(verdict.refusal, "");
    EXPECT_EQ(verdict.loop->query, KeyframeId(29));
    EXPECT_EQ(verdict.loop->candidate, KeyframeId(candidate));
    EXPECT_EQ(verdict.loop->query_from_candidate.scale, 1.0);
    EXPECT_LT(Distance(verdict.loop->query_from_candidate, Truth(made_, 29, candidate)), 0.01);
  }
}

// The measured motion between two images does not depend on the poses that tracking gave them.
TEST_F(LoopVerification, DoesNotDependOnTheDrift) {
  const LoopVerdict a = Verify(made_);
  const LoopVerdict b =
      Verify(MakeRingMap(world_, {.drift = Rigid3(ExpSo3({0.1, 0.5, 0.3}), {2.0, -1.0, 3.0})}));
  ASSERT_TRUE(a.loop && b.loop);
  EXPECT_LT(Distance(a.loop->query_from_candidate, b.loop->query_from_candidate), 1e-6);
  EXPECT_EQ(a.loop->landmarks.size(), b.loop->landmarks.size());
}

TEST_F(LoopVerification, ItsLandmarksAreThoseAroundTheCandidateThatTheQueryShows) {
  const LoopVerdict verdict = Verify(made_);
  ASSERT_TRUE(verdict.loop) << verdict.refusal;
  const std::vector<LandmarkId> around =
      ObservedLandmarks(made_.map, PlaceOf(made_.map, KeyframeId(5)));
  for (const auto& [keypoint, landmark] : verdict.loop->landmarks) {
    EXPECT_TRUE(std::binary_search(around.begin(), around.end(), landmark));
    const Observation& seen = made_.map.landmarks().At(landmark).observations.front();
    EXPECT_EQ(made_.views[seen.keyframe.value].points[seen.keypoint],
              made_.views[29].points[keypoint]);
  }
  EXPECT_GT(verdict.loop->landmarks.size(), 100u);
  EXPECT_LT(ObservedLandmarks(made_.map, std::vector{KeyframeId(5)}).size(), around.size());
}

TEST_F(LoopVerification, AnotherPlaceIsRefusedWithAReason) {
  for (const uint32_t candidate : {0u, 11u, 17u}) {
    const LoopVerdict verdict = Verify(made_, 29, candidate);
    EXPECT_FALSE(verdict.loop) << candidate;
    EXPECT_NE(verdict.refusal, "");
  }
}

TEST_F(LoopVerification, RefusesIfFewerLandmarksAgreeThanAsked) {
  const LoopVerdict verdict = Verify(made_);
  ASSERT_TRUE(verdict.loop);
  options_.min_matches = static_cast<int>(verdict.loop->landmarks.size()) + 1;
  const LoopVerdict refused = Verify(made_);
  EXPECT_FALSE(refused.loop);
  EXPECT_NE(refused.refusal.find("expected at least " + std::to_string(options_.min_matches)),
            std::string::npos)
      << refused.refusal;
}

// Landmarks of the query that the map lacks cannot agree with anything.
TEST_F(LoopVerification, AQueryWithoutLandmarksIsRefused) {
  const std::vector<LandmarkId> landmarks = made_.map.keyframes().At(KeyframeId(29)).landmarks;
  for (const LandmarkId id : landmarks) {
    if (id.IsValid()) {
      made_.map.EraseLandmark(id);
    }
  }
  EXPECT_FALSE(Verify(made_).loop);
}

TEST_F(LoopVerification, TheSameInputGivesTheSameBits) {
  const LoopVerdict a = Verify(made_);
  const LoopVerdict b = Verify(made_);
  ASSERT_TRUE(a.loop && b.loop);
  EXPECT_EQ(a.loop->query_from_candidate.rotation.coeffs(),
            b.loop->query_from_candidate.rotation.coeffs());
  EXPECT_EQ(a.loop->query_from_candidate.translation, b.loop->query_from_candidate.translation);
  ASSERT_EQ(a.loop->landmarks.size(), b.loop->landmarks.size());
  for (size_t i = 0; i < a.loop->landmarks.size(); ++i) {
    EXPECT_EQ(a.loop->landmarks[i].keypoint, b.loop->landmarks[i].keypoint);
    EXPECT_EQ(a.loop->landmarks[i].landmark, b.loop->landmarks[i].landmark);
  }
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/keyframe_policy.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hullslam {
namespace {

// The duration of this many frames at 30 frames/s, s.
double Frames(int count) { return count / 30.0; }

// Healthy tracking in a grown map: no reason for a keyframe.
KeyframeEvidence Healthy() {
  return {.time_since_keyframe = Frames(10),
          .inliers = 180,
          .reference_landmarks = 200,
          .close_tracked = 150,
          .close_untracked = 20,
          .keyframes = 5,
          .mapper_is_idle = true,
          .requests_waiting = 0};
}

struct Case {
  std::string what;
  KeyframeEvidence evidence;
  bool expected = false;
};

template <typename Change>
KeyframeEvidence With(const Change& change) {
  KeyframeEvidence evidence = Healthy();
  change(evidence);
  return evidence;
}

void ExpectDecisions(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    EXPECT_EQ(KeyframePolicy().NeedsKeyframe(c.evidence), c.expected) << c.what;
  }
}

TEST(KeyframePolicy, AsksWhenTrackingHasWeakenedAgainstTheReference) {
  ExpectDecisions({
      {"90 % of the reference", Healthy(), false},
      {"just below 90 %", With([](auto& e) { e.inliers = 179; }), true},
      {"a reference without landmarks", With([](auto& e) { e.reference_landmarks = 0; }), false},
  });
}

TEST(KeyframePolicy, AKnownViewNeedsNoKeyframe) {
  const auto weak = [](auto& e) { e.inliers = 100, e.close_tracked = 90, e.close_untracked = 80; };
  ExpectDecisions({
      {"a new view", With(weak), true},
      {"a known one", With([&](auto& e) { weak(e), e.is_known_view = true; }), false},
      {"a mature map", With([&](auto& e) { weak(e), e.is_well_mapped = true; }), false},
      {"with an unknown object",
       With([&](auto& e) { weak(e), e.is_known_view = true, e.unknown_objects = 1; }), true},
  });
}

TEST(KeyframePolicy, WaitsLongerWhileThereIsASingleKeyframe) {
  ExpectDecisions({
      {"exactly 40 %", With([](auto& e) { e.keyframes = 1, e.inliers = 80; }), false},
      {"just below 40 %", With([](auto& e) { e.keyframes = 1, e.inliers = 79; }), true},
      {"two keyframes, 40 %", With([](auto& e) { e.keyframes = 2, e.inliers = 80; }), true},
  });
}

TEST(KeyframePolicy, AsksWhenClosePointsWouldBeLost) {
  const auto close = [](int tracked, int untracked) {
    return With([=](auto& e) { e.close_tracked = tracked, e.close_untracked = untracked; });
  };
  ExpectDecisions({
      {"few tracked, many not", close(99, 71), true},
      {"enough tracked", close(100, 71), false},
      {"few not tracked", close(99, 70), false},
  });
}

TEST(KeyframePolicy, TimeAloneIsNoReasonForAKeyframe) {
  ExpectDecisions({
      {"overdue but healthy", With([](auto& e) { e.time_since_keyframe = Frames(1000); }), false},
  });
}

TEST(KeyframePolicy, ABusyMapperIsAskedOnlyWhenOverdueOrUrgent) {
  const auto busy = [](int inliers, int frames) {
    return With([=](auto& e) {
      e.mapper_is_idle = false;
      e.inliers = inliers;
      e.time_since_keyframe = Frames(frames);
    });
  };
  ExpectDecisions({
      {"weak", busy(100, 29), false},
      {"weak and overdue", busy(100, 30), true},
      {"at 50 %", busy(100, 10), false},
      {"below 50 %", busy(99, 10), true},
      {"close points would be lost", With([](auto& e) {
         e.mapper_is_idle = false;
         e.close_tracked = 99;
         e.close_untracked = 71;
       }),
       true},
  });
}

TEST(KeyframePolicy, LeavesTimeBetweenKeyframesUnlessTrackingWeakensAbruptly) {
  const auto after = [](int frames, int inliers) {
    return With([=](auto& e) { e.time_since_keyframe = Frames(frames), e.inliers = inliers; });
  };
  ExpectDecisions({
      {"weak, but 5 frames after the last", after(5, 150), false},
      {"weak, 6 frames after", after(6, 150), true},
      {"half of the reference, one frame after", after(1, 100), false},
      {"less than half, one frame after", after(1, 99), true},
      {"close points would be lost, one frame after", With([](auto& e) {
         e.time_since_keyframe = Frames(1);
         e.close_tracked = 99;
         e.close_untracked = 71;
       }),
       false},
  });
}

// A pose that needs landmarks of two keyframes is no basis for the next ones.
TEST(KeyframePolicy, WithoutDepthAnAbruptKeyframeNeedsLandmarksOfMoreThanTwoKeyframes) {
  KeyframePolicy policy;
  policy.has_depth = false;
  policy.min_confirmed = 30;
  const auto needs = [&](int frames, int confirmed) {
    return policy.NeedsKeyframe(With([=](auto& e) {
      e.time_since_keyframe = Frames(frames);
      e.inliers = 60;
      e.confirmed_inliers = confirmed;
    }));
  };
  EXPECT_TRUE(needs(1, 30));
  EXPECT_FALSE(needs(1, 29));
  EXPECT_FALSE(needs(5, 29));
  EXPECT_TRUE(needs(6, 29)) << "in its time it is made as before";
}

// Images that are far apart: this one finds enough, but the next one may not.
TEST(KeyframePolicy, AsksBeforeTheViewOfTheReferenceIsLeft) {
  const auto leaving = [](double overlap, int frames, bool is_idle) {
    return With([=](auto& e) {
      e.next_overlap = overlap;
      e.time_since_keyframe = Frames(frames);
      e.mapper_is_idle = is_idle;
    });
  };
  ExpectDecisions({
      {"half of the view remains", leaving(0.5, 10, true), false},
      {"less remains", leaving(0.49, 10, true), true},
      {"less remains, the mapper is busy", leaving(0.49, 10, false), true},
      {"less remains, 5 frames after the last keyframe", leaving(0.49, 5, true), false},
  });
}

// Only keyframes are compared with earlier places.
TEST(KeyframePolicy, AsksOftenWhilePartsOfTheMapAreNotJoined) {
  const auto islands = [](int frames) {
    return With([&](auto& e) {
      e.has_islands = true;
      e.time_since_keyframe = Frames(frames);
    });
  };
  ExpectDecisions(
      {{"after a third of a second", islands(10), true}, {"before", islands(9), false}});
}

TEST(KeyframePolicy, AsksForObjectsThatAreNotMappedYet) {
  const auto after = [](int frames, bool is_idle) {
    return With([=](auto& e) {
      e.unknown_objects = 1;
      e.time_since_keyframe = Frames(frames);
      e.mapper_is_idle = is_idle;
    });
  };
  ExpectDecisions({
      {"9 frames after the last keyframe", after(9, true), false},
      {"10 frames after", after(10, true), true},
      {"10 frames after, the mapper is busy", after(10, false), false},
      {"long after, the mapper is busy", after(30, false), true},
  });
}

TEST(KeyframePolicy, WaitsLongerForObjectsAfterFruitlessRequests) {
  const auto after = [](int fruitless, int frames) {
    return With([=](auto& e) {
      e.unknown_objects = 1;
      e.fruitless_requests = fruitless;
      e.time_since_keyframe = Frames(frames);
    });
  };
  ExpectDecisions({
      {"3 fruitless requests, 10 frames after the last keyframe", after(3, 10), true},
      {"4 fruitless requests, 19 frames after", after(4, 19), false},
      {"4 fruitless requests, 20 frames after", after(4, 20), true},
      {"6 fruitless requests, 79 frames after", after(6, 79), false},
      {"6 fruitless requests, 80 frames after", after(6, 80), true},
      {"100 fruitless requests, 159 frames after", after(100, 159), false},
      {"100 fruitless requests, 160 frames after", after(100, 160), true},
  });
}

TEST(KeyframePolicy, TellsWhetherAKeyframeIsNeededForObjectsAlone) {
  const auto evidence = [](int unknown, int inliers) {
    return With([=](auto& e) {
      e.unknown_objects = unknown;
      e.inliers = inliers;
      e.time_since_keyframe = Frames(12);
    });
  };
  const KeyframePolicy policy;
  EXPECT_TRUE(policy.NeedsKeyframeForObjects(evidence(1, 200)));
  EXPECT_FALSE(policy.NeedsKeyframeForObjects(evidence(0, 200)));  // not needed at all
  EXPECT_FALSE(policy.NeedsKeyframeForObjects(evidence(1, 150)));  // tracking needs it too
}

// Time stamps of cameras jitter by some milliseconds.
TEST(KeyframePolicy, ATimeIsReachedHalfAFrameEarlier) {
  const auto after = [](double seconds) {
    return With([=](auto& e) { e.time_since_keyframe = seconds, e.inliers = 150; });
  };
  ExpectDecisions({
      {"more than half a frame too early", after(0.183), false},
      {"less than half a frame too early", after(0.184), true},
  });
  KeyframePolicy policy;
  policy.time_tolerance = 0.05;  // 10 frames/s
  EXPECT_FALSE(policy.NeedsKeyframe(after(0.149)));
  EXPECT_TRUE(policy.NeedsKeyframe(after(0.151)));
}

TEST(KeyframePolicy, AFrameWithTooFewLandmarksIsNoKeyframe) {
  ExpectDecisions({
      {"15 landmarks", With([](auto& e) { e.inliers = 15; }), true},
      {"14 landmarks", With([](auto& e) { e.inliers = 14; }), false},
      {"objects alone", With([](auto& e) { e.inliers = 0, e.unknown_objects = 3; }), false},
  });
}

TEST(KeyframePolicy, NeverAsksWhileTooManyRequestsWait) {
  ExpectDecisions({
      {"two requests wait", With([](auto& e) { e.inliers = 20, e.requests_waiting = 2; }), true},
      {"three requests wait", With([](auto& e) { e.inliers = 20, e.requests_waiting = 3; }), false},
  });
}

TEST(KeyframePolicy, BoundsAreThoseOfTheFields) {
  KeyframePolicy policy;
  policy.min_time_between = 0.4;
  EXPECT_FALSE(policy.NeedsKeyframe(With([](auto& e) { e.inliers = 149; })));
  policy = KeyframePolicy();
  policy.min_reference_ratio = 0.95;
  EXPECT_TRUE(policy.NeedsKeyframe(Healthy()));
}

}  // namespace
}  // namespace hullslam

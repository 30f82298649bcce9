// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/lost_frames.h"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

constexpr TrackingState kTracked = TrackingState::kTracked;
constexpr TrackingState kLost = TrackingState::kLost;
constexpr TrackingState kNone = TrackingState::kNotInitialized;

// A run of every second frame of a sequence, ten frames a second.
class LostFrames : public testing::Test {
 protected:
  void Add(TrackingState state, TrackingState at_end,
           std::optional<TrackingFailure> loss = std::nullopt) {
    TrackedFrame& frame = frames_.emplace_back();
    frame.timestamp = 0.1 * static_cast<double>(notes_.size());
    frame.state = at_end;
    notes_.push_back({.number = 2 * notes_.size(), .state = state, .loss = loss});
  }
  std::vector<LostStretch> Find() const { return FindLostStretches(frames_, notes_); }

  std::vector<TrackedFrame> frames_;
  std::vector<FrameNote> notes_;
};

TEST_F(LostFrames, OfARunWithAllPosesThereAreNone) {
  Add(kTracked, kTracked);
  Add(kLost, kTracked, TrackingFailure::kNotRecognised);  // located at the end
  EXPECT_TRUE(Find().empty());
}

TEST_F(LostFrames, AreNamedByNumberTimeAndTheReasonOfTheFirst) {
  Add(kTracked, kTracked);
  Add(kLost, kLost, TrackingFailure::kTooFewFeatures);
  Add(kLost, kLost, TrackingFailure::kNotRecognised);
  Add(kTracked, kTracked);
  Add(kLost, kLost, TrackingFailure::kTooFewLandmarks);
  const std::vector<LostStretch> found = Find();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].first_frame, 2u);
  EXPECT_EQ(found[0].last_frame, 4u);
  EXPECT_EQ(found[0].first_timestamp, 0.1);
  EXPECT_EQ(found[0].last_timestamp, 0.2);
  EXPECT_EQ(found[0].frames, 2u);
  EXPECT_EQ(found[0].reason, TrackingFailure::kTooFewFeatures);
  EXPECT_EQ(found[1].first_frame, 8u);
  EXPECT_EQ(found[1].frames, 1u);
  EXPECT_EQ(found[1].reason, TrackingFailure::kTooFewLandmarks);
}

// They were tracked, so they need another remedy than frames that were lost before them.
TEST_F(LostFrames, FramesOfAnIslandAreAStretchOfTheirOwn) {
  Add(kNone, kNone);
  Add(kLost, kLost, TrackingFailure::kImagesMissing);
  Add(kTracked, kLost);
  Add(kTracked, kLost);
  const std::vector<LostStretch> found = Find();
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].reason, TrackingFailure::kNoMapYet);
  EXPECT_EQ(found[1].reason, TrackingFailure::kImagesMissing);
  EXPECT_EQ(found[2].reason, TrackingFailure::kNotJoined);
  EXPECT_EQ(found[2].frames, 2u);
}

TEST_F(LostFrames, EachFrameNeedsANote) {
  Add(kLost, kLost);
  notes_.clear();
  EXPECT_THROW(Find(), CheckError);
}

TEST(LostFramesAdvice, IsAnotherOneForEachReason) {
  for (const TrackingFailure a : kTrackingFailures) {
    for (const TrackingFailure b : kTrackingFailures) {
      EXPECT_EQ(AdviceFor(a) == AdviceFor(b), a == b);
    }
  }
}

// A run of every second frame of a sequence, ten frames a second.
class UnsureFrames : public testing::Test {
 protected:
  void Add(bool is_unsure, TrackingState at_end = TrackingState::kTracked) {
    TrackedFrame& frame = frames_.emplace_back();
    frame.timestamp = 0.1 * static_cast<double>(notes_.size());
    frame.state = at_end;
    notes_.push_back(
        {.number = 2 * notes_.size(), .state = TrackingState::kTracked, .is_unsure = is_unsure});
  }
  std::vector<FrameStretch> Find() const { return FindUnsureStretches(frames_, notes_); }

  std::vector<TrackedFrame> frames_;
  std::vector<FrameNote> notes_;
};

TEST_F(UnsureFrames, OfARunThatIsSureThereAreNone) {
  Add(false);
  Add(false);
  EXPECT_TRUE(Find().empty());
}

TEST_F(UnsureFrames, AreNamedByNumberAndTime) {
  for (const bool is_unsure : {false, true, true, false, true}) {
    Add(is_unsure);
  }
  const std::vector<FrameStretch> found = Find();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].first_frame, 2u);
  EXPECT_EQ(found[0].last_frame, 4u);
  EXPECT_EQ(found[0].first_timestamp, 0.1);
  EXPECT_EQ(found[0].last_timestamp, 0.2);
  EXPECT_EQ(found[0].frames, 2u);
  EXPECT_EQ(found[1].first_frame, 8u);
  EXPECT_EQ(found[1].last_frame, 8u);
  EXPECT_EQ(found[1].frames, 1u);
}

TEST_F(UnsureFrames, FramesThatHaveNoPoseAtTheEndAreLost) {
  Add(true);
  Add(true, TrackingState::kLost);
  Add(true);
  const std::vector<FrameStretch> found = Find();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].last_frame, 0u);
  EXPECT_EQ(found[1].first_frame, 4u);
}

TEST_F(UnsureFrames, EachFrameNeedsANote) {
  Add(true);
  notes_.clear();
  EXPECT_THROW(Find(), CheckError);
}

}  // namespace

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/unsure_frames.h"

#include <gtest/gtest.h>

#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

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

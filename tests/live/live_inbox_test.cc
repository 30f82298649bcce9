// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_inbox.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

LiveFrame TrackedAt(double timestamp, TrackingState state = TrackingState::kTracked) {
  LiveFrame frame;
  frame.report.tracked.timestamp = timestamp;
  frame.report.tracked.state = state;
  if (state == TrackingState::kLost) {
    frame.report.loss = TrackingFailure{};
  }
  return frame;
}

TEST(LiveInbox, HasRoomForOneFrame) {
  LiveInbox inbox;
  EXPECT_FALSE(inbox.TakeFrame());
  inbox.Put(TrackedAt(1.0));
  inbox.Put(TrackedAt(2.0));
  const auto frame = inbox.TakeFrame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->report.tracked.timestamp, 2.0);
  EXPECT_FALSE(inbox.TakeFrame());
  EXPECT_EQ(inbox.state().path.size(), 2u);
}

TEST(LiveInbox, NotesWhenTheCameraWasLostAndFoundAgain) {
  LiveInbox inbox;
  inbox.Put(TrackedAt(1.0));
  inbox.Put(TrackedAt(2.0, TrackingState::kLost));
  inbox.Put(TrackedAt(3.0, TrackingState::kLost));
  EXPECT_TRUE(inbox.state().losses.empty());
  inbox.Put(TrackedAt(4.0));
  const LiveState state = inbox.state();
  ASSERT_EQ(state.losses.size(), 1u);
  EXPECT_EQ(state.losses[0].from, 2.0);
  EXPECT_EQ(state.losses[0].to, 3.0);
  EXPECT_EQ(state.losses[0].frames, 2u);
  EXPECT_EQ(state.losses[0].reason, ToString(TrackingFailure{}));
  EXPECT_EQ(state.loss_count, 1u);
}

TEST(LiveInbox, DoesNotGrowWithTheRun) {
  LiveInbox inbox;
  for (int i = 0; i < 40000; ++i) {
    inbox.Put(TrackedAt(i, i % 2 == 0 ? TrackingState::kTracked : TrackingState::kLost));
  }
  const LiveState state = inbox.state();
  EXPECT_LE(state.path.size(), 4000u);
  EXPECT_EQ(state.losses.size(), 200u);
  EXPECT_EQ(state.loss_count, 19999u);
  EXPECT_EQ(state.losses.back().from, 39997.0);
  EXPECT_GT(inbox.rate(), 0.0);
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_inbox.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TrackedFrame FrameAt(int number, TrackingState state = TrackingState::kTracked) {
  TrackedFrame frame;
  frame.timestamp = number;
  frame.state = state;
  return frame;
}

TEST(TrackHistory, KeepsAllFramesOfAShortRun) {
  TrackHistory history(100);
  for (int i = 0; i < 50; ++i) {
    history.Add(FrameAt(i, i % 10 == 3 ? TrackingState::kLost : TrackingState::kTracked));
  }
  EXPECT_EQ(history.frames().size(), 45u);
  EXPECT_EQ(history.thinnings(), 0u);
}

TEST(TrackHistory, KeepsALongRunEvenly) {
  TrackHistory history(100);
  for (int i = 0; i < 100000; ++i) {
    history.Add(FrameAt(i));
  }
  std::vector<TrackedFrame> frames = history.frames();
  EXPECT_EQ(frames.back().timestamp, 99999);
  frames.pop_back();  // the newest one is no multiple of the step
  ASSERT_LE(frames.size(), 100u);
  ASSERT_GE(frames.size(), 48u);
  const double step = frames[1].timestamp - frames[0].timestamp;
  for (size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].timestamp - frames[i - 1].timestamp, step);
  }
  EXPECT_GT(history.thinnings(), 0u);
}

// Otherwise the path of a run of an hour would end two seconds behind the camera.
TEST(TrackHistory, TheNewestFrameIsTheLast) {
  TrackHistory history(10);
  for (int i = 0; i < 1000; ++i) {
    history.Add(FrameAt(i));
    ASSERT_EQ(history.frames().back().timestamp, i);
  }
  history.Add(FrameAt(1000, TrackingState::kLost));
  EXPECT_EQ(history.frames().back().timestamp, 999);
}

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

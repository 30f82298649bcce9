// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/track_history.h"

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

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/message_hub.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>

namespace hullslam {
namespace {

using namespace std::chrono_literals;

SharedMessage Text(const std::string& text) { return std::make_shared<const std::string>(text); }

// The next message of a reader, or "-".
std::string TakeText(MessageHub& hub, MessageHub::ReaderId reader) {
  const SharedMessage message = hub.Take(reader);
  return message != nullptr ? *message : "-";
}

TEST(MessageHub, ANewReaderBeginsWithTheWholeMap) {
  MessageHub hub;
  EXPECT_FALSE(hub.NeedsWhole());
  const auto reader = hub.AddReader();
  EXPECT_EQ(hub.reader_count(), 1u);
  EXPECT_TRUE(hub.NeedsWhole());
  hub.GiveMapChange(Text("change 1"));
  hub.GiveFrame(Text("frame 1"));
  EXPECT_EQ(TakeText(hub, reader), "-");
  hub.GiveWhole(Text("whole"));
  EXPECT_FALSE(hub.NeedsWhole());
  hub.GiveFrame(Text("frame 2"));
  EXPECT_EQ(TakeText(hub, reader), "whole");
  EXPECT_EQ(TakeText(hub, reader), "frame 2");
  hub.GiveMapChange(Text("change 2"));
  EXPECT_EQ(TakeText(hub, reader), "change 2");
  EXPECT_EQ(TakeText(hub, reader), "-");
}

TEST(MessageHub, OnlyTheNewestFrameIsKept) {
  MessageHub hub;
  const auto reader = hub.AddReader();
  hub.GiveWhole(Text("whole"));
  TakeText(hub, reader);
  for (int i = 0; i < 1000; ++i) {
    hub.GiveFrame(Text("frame " + std::to_string(i)));
  }
  EXPECT_EQ(TakeText(hub, reader), "frame 999");
  EXPECT_EQ(TakeText(hub, reader), "-");
}

TEST(MessageHub, ASlowReaderLosesChangesAndGetsTheWholeMapWhenItAsksAgain) {
  MessageHub hub;
  const auto slow = hub.AddReader();
  const auto fast = hub.AddReader();
  hub.GiveWhole(Text("whole"));
  TakeText(hub, fast);
  EXPECT_EQ(TakeText(hub, slow), "whole");  // and it is long in sending it
  for (int i = 0; i < 5; ++i) {
    hub.GiveMapChange(Text("change " + std::to_string(i)));
    EXPECT_EQ(TakeText(hub, fast), "change " + std::to_string(i));
    EXPECT_EQ(TakeText(hub, fast), "-");
  }
  EXPECT_FALSE(hub.NeedsWhole());  // not before it is ready
  EXPECT_EQ(TakeText(hub, slow), "-");
  EXPECT_TRUE(hub.NeedsWhole());
  hub.GiveWhole(Text("whole again"));
  EXPECT_EQ(TakeText(hub, slow), "whole again");
  EXPECT_EQ(TakeText(hub, fast), "-");
}

TEST(MessageHub, ReadersCanLeaveAndBeLeftBehind) {
  MessageHub hub;
  const auto reader = hub.AddReader();
  hub.GiveWhole(Text("whole"));
  TakeText(hub, reader);
  TakeText(hub, reader);
  hub.LeaveBehind();
  EXPECT_TRUE(hub.NeedsWhole());
  hub.RemoveReader(reader);
  EXPECT_EQ(hub.reader_count(), 0u);
  EXPECT_EQ(TakeText(hub, reader), "-");
  EXPECT_TRUE(hub.WaitUntilSent(0ms));
}

TEST(MessageHub, NotifiesAndWaitsUntilAllIsSent) {
  std::atomic<int> notified = 0;
  MessageHub hub([&] { ++notified; });
  const auto reader = hub.AddReader();
  hub.GiveWhole(Text("whole"));
  EXPECT_EQ(notified, 1);
  EXPECT_FALSE(hub.WaitUntilSent(1ms));
  hub.Take(reader);
  EXPECT_FALSE(hub.WaitUntilSent(1ms)) << "it is still being sent";
  std::thread taker([&] { hub.Take(reader); });
  EXPECT_TRUE(hub.WaitUntilSent(10s));
  taker.join();
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/pause_gate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace hullslam {
namespace {

using namespace std::chrono_literals;

bool Never() { return false; }

TEST(PauseGate, IsOpenAtFirst) {
  PauseGate gate;
  EXPECT_FALSE(gate.IsPaused());
  EXPECT_EQ(gate.Pass(Never), 0ns);
}

TEST(PauseGate, HoldsTheThreadUntilItIsResumedAndSaysHowLong) {
  PauseGate gate;
  gate.Pause();
  EXPECT_TRUE(gate.IsPaused());
  std::atomic<bool> is_waiting = false;
  PauseGate::Clock::duration waited{};
  std::thread thread([&] { waited = gate.Pass(Never, [&] { is_waiting = true; }); });
  while (!is_waiting) {
    std::this_thread::yield();
  }
  std::this_thread::sleep_for(30ms);
  gate.Resume();
  thread.join();
  EXPECT_GE(waited, 30ms);
  EXPECT_EQ(gate.Pass(Never), 0ns);
}

TEST(PauseGate, AStepLetsOneFramePass) {
  PauseGate gate;
  gate.Step();
  EXPECT_TRUE(gate.IsPaused());
  EXPECT_EQ(gate.Pass(Never), 0ns);
  int asked = 0;
  gate.Pass([&] { return ++asked > 1; });
  EXPECT_EQ(asked, 2);
}

TEST(PauseGate, StepsDoNotPileUpAndAPauseForgetsThem) {
  PauseGate gate;
  for (int i = 0; i < 1000; ++i) {
    gate.Step();
  }
  int passed = 0;
  while (gate.Pass([] { return true; }) == 0ns && passed < 1000) {
    ++passed;
  }
  EXPECT_LE(passed, 10);
  gate.Step();
  gate.Pause();
  EXPECT_GT(gate.Pass([] { return true; }), 0ns);
}

TEST(PauseGate, AnInterruptionAndTheEndOpenIt) {
  PauseGate gate;
  gate.Pause();
  EXPECT_GE(gate.Pass([] { return true; }), 0ns);
  gate.Open();
  gate.Pause();
  EXPECT_FALSE(gate.IsPaused());
  EXPECT_EQ(gate.Pass(Never), 0ns);
}

}  // namespace
}  // namespace hullslam

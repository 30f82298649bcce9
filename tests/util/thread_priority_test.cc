// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/thread_priority.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <thread>

namespace hullslam {
namespace {

TEST(RunInBackground, GivesTheNicenessThatIsAskedForButNeverALowerOne) {
  const int before = getpriority(PRIO_PROCESS, 0);
  int first = 0;
  int second = 0;
  std::thread([&] {
    RunInBackground(before + 3);
    first = getpriority(PRIO_PROCESS, 0);
    RunInBackground(before + 1);
    second = getpriority(PRIO_PROCESS, 0);
  }).join();
  EXPECT_EQ(first, std::min(before + 3, 19));
  EXPECT_EQ(second, first);
}

TEST(RunInBackground, LowersThePriorityOfTheCallingThreadAlone) {
  const int before = getpriority(PRIO_PROCESS, 0);
  int in_thread = 0;
  std::thread([&] {
    RunInBackground();
    in_thread = getpriority(PRIO_PROCESS, 0);
  }).join();
  EXPECT_GE(in_thread, kBackgroundNiceness);
  EXPECT_GE(in_thread, before);
  EXPECT_EQ(getpriority(PRIO_PROCESS, 0), before);
}

}  // namespace
}  // namespace hullslam

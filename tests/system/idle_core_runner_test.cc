// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/idle_core_runner.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <latch>
#include <set>
#include <stdexcept>
#include <vector>

namespace hullslam {
namespace {

TEST(IdleCoreRunner, RunsEachTaskOnce) {
  IdleCoreRunner runner([] { return true; });
  for (size_t count = 0; count < 200; ++count) {
    std::vector<std::atomic<int>> runs(count);
    runner.Run(count, [&](size_t task) { ++runs[task]; });
    for (size_t task = 0; task < count; ++task) {
      EXPECT_EQ(runs[task], 1) << task << " of " << count;
    }
  }
}

// Each of the two tasks waits for the other one.
TEST(IdleCoreRunner, TwoTasksRunAtTheSameTimeIfACoreIsIdle) {
  IdleCoreRunner runner([] { return true; });
  std::latch both(2);
  runner.Run(2, [&](size_t) { both.arrive_and_wait(); });
  EXPECT_TRUE(both.try_wait());
}

TEST(IdleCoreRunner, TheSecondThreadRunsOnAnotherCore) {
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof(allowed), &allowed), 0);
  if (CPU_COUNT(&allowed) < 2) {
    GTEST_SKIP() << "this process may use one core only";
  }
  IdleCoreRunner runner([] { return true; });
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (!CPU_ISSET(core, &allowed)) {
      continue;
    }
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(core, &only);
    ASSERT_EQ(sched_setaffinity(0, sizeof(only), &only), 0);
    std::latch both(2);
    std::atomic<int> here{0};
    runner.Run(2, [&](size_t) {
      both.arrive_and_wait();
      here += sched_getcpu() == core ? 1 : 0;
    });
    EXPECT_EQ(here, 1) << "core " << core;
  }
  ASSERT_EQ(sched_setaffinity(0, sizeof(allowed), &allowed), 0);
}

TEST(IdleCoreRunner, TheCallerWorksAloneIfNoCoreIsIdle) {
  int asked = 0;
  IdleCoreRunner runner([&] {
    ++asked;
    return false;
  });
  std::set<std::thread::id> threads;
  std::vector<size_t> tasks;
  runner.Run(50, [&](size_t task) {
    threads.insert(std::this_thread::get_id());
    tasks.push_back(task);
  });
  EXPECT_EQ(threads, (std::set<std::thread::id>{std::this_thread::get_id()}));
  EXPECT_EQ(tasks.size(), 50u);
  EXPECT_EQ(asked, 1);
}

TEST(IdleCoreRunner, ThrowsTheExceptionOfATaskAndGoesOn) {
  IdleCoreRunner runner([] { return true; });
  for (size_t bad = 0; bad < 20; ++bad) {
    std::atomic<size_t> begun{0};
    const auto task = [&](size_t number) {
      ++begun;
      if (number == bad) {
        throw std::runtime_error("a bad task");
      }
    };
    EXPECT_THROW(runner.Run(20, task), std::runtime_error);
    EXPECT_GE(begun, bad + 1);
    begun = 0;
    runner.Run(bad, task);
    EXPECT_EQ(begun, bad);
  }
}

}  // namespace
}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/task_runner.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

TEST(SerialRunner, RunsEachTaskInOrder) {
  std::vector<size_t> tasks;
  SerialRunner().Run(4, [&](size_t task) { tasks.push_back(task); });
  EXPECT_EQ(tasks, (std::vector<size_t>{0, 1, 2, 3}));
  SerialRunner().Run(0, [](size_t) { FAIL() << "there is no task"; });
}

TEST(SerialRunner, BeginsNoTaskAfterAnException) {
  size_t begun = 0;
  const auto task = [&](size_t number) {
    ++begun;
    if (number == 1) {
      throw std::runtime_error("task 1");
    }
  };
  EXPECT_THROW(SerialRunner().Run(4, task), std::runtime_error);
  EXPECT_EQ(begun, 2u);
}

TEST(SharedTasks, OneThreadDoesAllInOrder) {
  std::vector<size_t> done;
  const std::function<void(size_t)> task = [&](size_t number) { done.push_back(number); };
  SharedTasks tasks(3, task);
  tasks.Work();
  tasks.Work();  // nothing is left for the second thread
  EXPECT_EQ(done, (std::vector<size_t>{0, 1, 2}));
  EXPECT_NO_THROW(tasks.RethrowFailure());
}

TEST(SharedTasks, AnExceptionEndsTheWorkAndIsKept) {
  size_t begun = 0;
  const std::function<void(size_t)> task = [&](size_t number) {
    ++begun;
    if (number == 1) {
      throw std::runtime_error("task 1");
    }
  };
  SharedTasks tasks(4, task);
  EXPECT_NO_THROW(tasks.Work());
  EXPECT_EQ(begun, 2u);
  EXPECT_THROW(tasks.RethrowFailure(), std::runtime_error);
}

TEST(ParallelRunner, RunsEachTaskOnce) {
  for (const int threads : {0, 1, 2, 5}) {
    ParallelRunner runner(threads);
    std::vector<int> calls(100, 0);
    runner.Run(100, [&](size_t task) { ++calls[task]; });
    EXPECT_EQ(calls, std::vector<int>(100, 1)) << threads;
    runner.Run(0, [](size_t) { FAIL() << "there is no task"; });
  }
}

TEST(ParallelRunner, UsesSeveralThreads) {
  std::atomic<int> waiting = 0;
  ParallelRunner(2).Run(2, [&](size_t) {
    ++waiting;
    while (waiting < 2) {  // ends only if both tasks run at the same time
    }
  });
  EXPECT_EQ(waiting, 2);
}

TEST(ParallelRunner, ThrowsTheExceptionOfATask) {
  EXPECT_THROW(ParallelRunner(2).Run(10,
                                     [](size_t task) {
                                       if (task == 3) {
                                         throw std::runtime_error("task 3");
                                       }
                                     }),
               std::runtime_error);
  EXPECT_THROW(ParallelRunner(-1), CheckError);
}

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

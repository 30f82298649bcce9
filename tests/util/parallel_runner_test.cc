// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/parallel_runner.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

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

}  // namespace
}  // namespace hullslam

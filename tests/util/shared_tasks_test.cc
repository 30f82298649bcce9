// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/shared_tasks.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace hullslam {
namespace {

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

}  // namespace
}  // namespace hullslam

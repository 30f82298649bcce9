// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/task_runner.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

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

}  // namespace
}  // namespace hullslam

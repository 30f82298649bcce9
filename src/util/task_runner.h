// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

namespace hullslam {

// Runs tasks that do not depend on each other, so that their results are the same in any order and
// on any number of threads.
class TaskRunner {
 public:
  virtual ~TaskRunner() = default;

  // Calls task(0) to task(count - 1) and returns when all of them have returned. They are begun in
  // this order, but several may run at the same time. If a task throws an exception, no further
  // task is begun, and the exception is rethrown.
  virtual void Run(size_t count, const std::function<void(size_t)>& task) = 0;
};

// Runs the tasks one after the other, in the calling thread.
class SerialRunner final : public TaskRunner {
 public:
  void Run(size_t count, const std::function<void(size_t)>& task) override {
    for (size_t i = 0; i < count; ++i) {
      task(i);
    }
  }
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

#include "util/task_runner.h"

namespace hullslam {

// Runs tasks in the calling thread and in other threads. Each Run starts its own threads, so only
// long tasks become faster.
class ParallelRunner final : public TaskRunner {
 public:
  // `threads` counts the calling thread; 0: one per core of the computer.
  explicit ParallelRunner(int threads);

  void Run(size_t count, const std::function<void(size_t)>& task) override;

 private:
  size_t threads_;
};

}  // namespace hullslam

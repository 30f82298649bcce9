// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "hullslam/util/task_runner.h"
#include "util/shared_tasks.h"

namespace hullslam {

// Runs tasks in the calling thread. If another core is idle when Run is called, a second thread
// helps. Run is called by one thread at a time.
class IdleCoreRunner final : public TaskRunner {
 public:
  // `has_idle_core` is called once per Run, by its thread.
  explicit IdleCoreRunner(std::function<bool()> has_idle_core);
  ~IdleCoreRunner() override;
  IdleCoreRunner(const IdleCoreRunner&) = delete;
  IdleCoreRunner& operator=(const IdleCoreRunner&) = delete;

  void Run(size_t count, const std::function<void(size_t)>& task) override;

 private:
  void RunHelper();

  const std::function<bool()> has_idle_core_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  SharedTasks* offered_ = nullptr;  // what the helper may begin to work on
  bool is_helping_ = false;
  bool is_closed_ = false;
  std::thread helper_;  // last member, because the thread uses the others
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sched.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "util/task_runner.h"

namespace hullslam {

// Runs tasks in the calling thread. If another core is idle when Run is called, a second thread
// helps. Run is called by one thread at a time.
//
// Waking a sleeping thread takes about as long as computing the lines of a mask. So before they
// sleep, both threads poll for new work for a fraction of a millisecond.
class IdleCoreRunner final : public TaskRunner {
 public:
  // `has_idle_core` is called once per Run, by its thread.
  explicit IdleCoreRunner(std::function<bool()> has_idle_core);
  ~IdleCoreRunner() override;
  IdleCoreRunner(const IdleCoreRunner&) = delete;
  IdleCoreRunner& operator=(const IdleCoreRunner&) = delete;

  void Run(size_t count, const std::function<void(size_t)>& task) override;

 private:
  void KeepHelperOffThisCore();
  void RunHelper();

  const std::function<bool()> has_idle_core_;
  cpu_set_t cores_{};      // the cores that the process may use
  int avoided_core_ = -1;  // the helper must not run on it; used by the thread that calls Run
  std::mutex mutex_;       // held when one of the members below is written
  std::condition_variable changed_;
  std::atomic<SharedTasks*> offered_ = nullptr;  // the tasks that the helper may work on
  std::atomic<bool> is_helping_ = false;
  std::atomic<bool> is_closed_ = false;
  std::thread helper_;  // last member, because the thread uses the others
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/idle_core_runner.h"

#include <utility>

namespace hullslam {

IdleCoreRunner::IdleCoreRunner(std::function<bool()> has_idle_core)
    : has_idle_core_(std::move(has_idle_core)), helper_([this] { RunHelper(); }) {}

IdleCoreRunner::~IdleCoreRunner() {
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
  }
  changed_.notify_all();
  helper_.join();
}

void IdleCoreRunner::Run(size_t count, const std::function<void(size_t)>& task) {
  if (count < 2 || !has_idle_core_()) {
    SerialRunner().Run(count, task);
    return;
  }
  SharedTasks tasks(count, task);
  {
    const std::lock_guard lock(mutex_);
    offered_ = &tasks;
  }
  changed_.notify_all();
  tasks.Work();
  {
    std::unique_lock lock(mutex_);
    offered_ = nullptr;  // the helper may have been too late
    changed_.wait(lock, [this] { return !is_helping_; });
  }
  tasks.RethrowFailure();
}

void IdleCoreRunner::RunHelper() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_closed_ || offered_ != nullptr; });
    if (is_closed_) {
      return;
    }
    SharedTasks* const tasks = std::exchange(offered_, nullptr);
    is_helping_ = true;
    lock.unlock();
    tasks->Work();
    lock.lock();
    is_helping_ = false;
    changed_.notify_all();
  }
}

}  // namespace hullslam

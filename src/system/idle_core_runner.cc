// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/idle_core_runner.h"

#include <pthread.h>

#include <chrono>
#include <utility>

namespace hullslam {
namespace {

constexpr std::chrono::microseconds kPatience(300);

// Polls the condition for a short time. Returns whether it holds.
template <typename Condition>
void Await(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition() && std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
}

}  // namespace

IdleCoreRunner::IdleCoreRunner(std::function<bool()> has_idle_core)
    : has_idle_core_(std::move(has_idle_core)), helper_([this] { RunHelper(); }) {
  if (sched_getaffinity(0, sizeof(cores_), &cores_) != 0) {
    CPU_ZERO(&cores_);
  }
}

IdleCoreRunner::~IdleCoreRunner() {
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
  }
  changed_.notify_all();
  helper_.join();
}

// The scheduler may wake the helper on the core of the thread that wakes it. It would then compete
// with that thread while the other core stays idle.
void IdleCoreRunner::KeepHelperOffThisCore() {
  const int core = sched_getcpu();
  if (core < 0 || core == avoided_core_) {
    return;
  }
  cpu_set_t others = cores_;
  CPU_CLR(core, &others);
  // If no other core is allowed, this fails, and the helper stays on its core.
  pthread_setaffinity_np(helper_.native_handle(), sizeof(others), &others);
  avoided_core_ = core;
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
  KeepHelperOffThisCore();
  changed_.notify_all();
  tasks.Work();
  {
    std::unique_lock lock(mutex_);
    offered_ = nullptr;  // the helper may have been too late
  }
  const auto has_helped = [this] { return !is_helping_; };
  Await(has_helped);
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, has_helped);
  }
  tasks.RethrowFailure();
}

void IdleCoreRunner::RunHelper() {
  const auto is_wanted = [this] { return is_closed_ || offered_ != nullptr; };
  while (true) {
    Await(is_wanted);
    std::unique_lock lock(mutex_);
    changed_.wait(lock, is_wanted);
    if (is_closed_) {
      return;
    }
    SharedTasks* const tasks = offered_.exchange(nullptr);
    is_helping_ = true;
    lock.unlock();
    tasks->Work();
    lock.lock();
    is_helping_ = false;
    changed_.notify_all();
  }
}

}  // namespace hullslam

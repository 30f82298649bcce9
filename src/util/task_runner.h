// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>

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

  // Calls one(0) to one(count - 1), which are so short that a task consists of many of them.
  template <typename One>
  void RunEach(size_t count, const One& one) {
    constexpr size_t kInTask = 128;
    Run((count + kInTask - 1) / kInTask, [&](size_t task) {
      for (size_t i = task * kInTask; i < std::min(count, (task + 1) * kInTask); ++i) {
        one(i);
      }
    });
  }
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

// Tasks for several threads. Each thread takes the next task that no thread has begun.
class SharedTasks {
 public:
  // `task` must outlive this object.
  SharedTasks(size_t count, const std::function<void(size_t)>& task) : count_(count), task_(task) {}

  // Returns when all tasks have begun and this thread's tasks have ended. After a task has thrown
  // an exception, no further task is begun.
  void Work() {
    for (size_t i = next_++; i < count_; i = next_++) {
      try {
        task_(i);
      } catch (...) {
        next_ = count_;
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
      }
    }
  }

  // Rethrows the first exception of a task, if there was one. To be called when no thread works any
  // more.
  void RethrowFailure() const {
    if (failure_) {
      std::rethrow_exception(failure_);
    }
  }

 private:
  const size_t count_;
  const std::function<void(size_t)>& task_;
  std::atomic<size_t> next_{0};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

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

// The niceness of threads in the background (setpriority(2)).
inline constexpr int kBackgroundNiceness = 10;

// Gives the calling thread at least this niceness. The thread then gets a smaller share of a core
// that other threads need too. With niceness 10 it gets about a tenth of a core that it shares with
// one thread of niceness 0.
void RunInBackground(int niceness = kBackgroundNiceness);

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>

namespace hullslam {

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

}  // namespace hullslam

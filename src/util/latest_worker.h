// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace hullslam {

// Works in its own thread on the newest of its tasks. A waiting task is dropped when another one
// arrives.
template <typename Task>
class LatestWorker {
 public:
  // Calls `work` with each task. After `work` has thrown an exception, no further task is begun.
  explicit LatestWorker(std::function<void(Task)> work)
      : work_(std::move(work)), thread_([this] { Run(); }) {}

  ~LatestWorker() {
    {
      const std::lock_guard lock(mutex_);
      is_closed_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  LatestWorker(const LatestWorker&) = delete;
  LatestWorker& operator=(const LatestWorker&) = delete;

  void Post(Task task) {
    const std::lock_guard lock(mutex_);
    next_ = std::move(task);
    changed_.notify_all();
  }

  // Whether a task waits or is being worked on.
  bool IsBusy() const {
    const std::lock_guard lock(mutex_);
    return IsBusyLocked();
  }

  void WaitUntilIdle() const {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !IsBusyLocked(); });
  }

  // Rethrows the exception of `work`, if there was one.
  void RethrowFailure() const {
    const std::lock_guard lock(mutex_);
    if (failure_) {
      std::rethrow_exception(failure_);
    }
  }

 private:
  bool IsBusyLocked() const { return !failure_ && (is_working_ || next_.has_value()); }

  void Run() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return is_closed_ || next_.has_value(); });
      if (is_closed_) {
        return;
      }
      Task task = std::move(*next_);
      next_.reset();
      is_working_ = true;
      lock.unlock();
      std::exception_ptr failure;
      try {
        work_(std::move(task));
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      is_working_ = false;
      failure_ = failure;
      changed_.notify_all();
      if (failure_) {
        return;
      }
    }
  }

  const std::function<void(Task)> work_;
  mutable std::mutex mutex_;  // guards the members below
  mutable std::condition_variable changed_;
  std::optional<Task> next_;
  bool is_working_ = false;
  bool is_closed_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  // last member, because the thread uses the others
};

// Makes results from the newest of its tasks in its own thread (LatestWorker), and keeps them until
// they are taken.
template <typename Task, typename Result>
class LatestMaker {
 public:
  explicit LatestMaker(std::function<Result(Task)> make)
      : worker_([this, make = std::move(make)](Task task) {
          Result result = make(std::move(task));
          const std::lock_guard lock(mutex_);
          results_.push_back(std::move(result));
        }) {}

  void Post(Task task) { worker_.Post(std::move(task)); }
  bool IsBusy() const { return worker_.IsBusy(); }
  void WaitUntilIdle() const { worker_.WaitUntilIdle(); }

  // All results that were not taken yet, in the order in which they were made. There may be several
  // if tasks were posted meanwhile. Rethrows the exception of `make`, if there was one.
  std::vector<Result> TakeResults() {
    worker_.RethrowFailure();
    const std::lock_guard lock(mutex_);
    return std::exchange(results_, {});
  }

 private:
  std::mutex mutex_;  // guards results_
  std::vector<Result> results_;
  LatestWorker<Task> worker_;  // last, because its thread uses the others
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include "util/latest_worker.h"

namespace hullslam {

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

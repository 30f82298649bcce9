// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/task_runner.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {

ParallelRunner::ParallelRunner(int threads)
    : threads_(threads > 0 ? static_cast<size_t>(threads)
                           : std::max(1u, std::thread::hardware_concurrency())) {
  Check(threads >= 0, "a number of threads is negative");
}

void ParallelRunner::Run(size_t count, const std::function<void(size_t)>& task) {
  SharedTasks tasks(count, task);
  {
    std::vector<std::jthread> helpers;
    for (size_t i = 1; i < std::min(threads_, count); ++i) {
      helpers.emplace_back([&] { tasks.Work(); });
    }
    tasks.Work();
  }
  tasks.RethrowFailure();
}

// On Linux each thread has a niceness of its own. If the call fails, the thread keeps its niceness.
// This only affects speed.
void RunInBackground(int niceness) {
  const auto thread = static_cast<id_t>(syscall(SYS_gettid));
  setpriority(PRIO_PROCESS, thread, std::max(niceness, getpriority(PRIO_PROCESS, thread)));
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/thread_priority.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

namespace hullslam {

// On Linux each thread has a niceness of its own. If the call fails, the thread keeps its niceness.
// This only affects speed.
void RunInBackground(int niceness) {
  const auto thread = static_cast<id_t>(syscall(SYS_gettid));
  setpriority(PRIO_PROCESS, thread, std::max(niceness, getpriority(PRIO_PROCESS, thread)));
}

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/interrupt.h"

#include <atomic>
#include <csignal>

namespace hullslam {
namespace {

// This is a global variable, because a signal handler gets no argument from the program. The
// handler may only use lock-free variables.
static_assert(std::atomic<bool>::is_always_lock_free);
Cancellation interruption;

}  // namespace

void CatchInterrupts() {
  struct sigaction action = {};
  action.sa_handler = [](int) { interruption.Request(); };
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction former = {};
    sigaction(signal, nullptr, &former);
    if (former.sa_handler != SIG_IGN) {
      sigaction(signal, &action, nullptr);
    }
  }
}

const Cancellation& Interruption() { return interruption; }

bool IsInterrupted() { return interruption.IsRequested(); }

}  // namespace hullslam

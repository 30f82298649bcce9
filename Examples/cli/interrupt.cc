// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/interrupt.h"

#include <atomic>
#include <csignal>

namespace hullslam {
namespace {

// A signal handler may only use lock-free variables, and it gets no argument of ours, so this is a
// global variable.
static_assert(std::atomic<bool>::is_always_lock_free);
Cancellation interruption;

}  // namespace

void CatchInterrupts() {
  struct sigaction action = {};
  action.sa_handler = [](int) { interruption.Request(); };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

const Cancellation& Interruption() { return interruption; }

bool IsInterrupted() { return interruption.IsRequested(); }

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/pause_gate.h"

#include <algorithm>

namespace hullslam {

void PauseGate::Pause() {
  const std::lock_guard lock(mutex_);
  is_paused_ = true;
  steps_ = 0;
}

void PauseGate::Resume() {
  const std::lock_guard lock(mutex_);
  is_paused_ = false;
  steps_ = 0;
  changed_.notify_all();
}

void PauseGate::Step() {
  // A browser that asks for steps faster than they are done does not queue them without end.
  constexpr size_t kMostSteps = 10;
  const std::lock_guard lock(mutex_);
  is_paused_ = true;
  steps_ = std::min(steps_ + 1, kMostSteps);
  changed_.notify_all();
}

void PauseGate::Open() {
  const std::lock_guard lock(mutex_);
  is_open_ = true;
  is_paused_ = false;
  changed_.notify_all();
}

bool PauseGate::IsPaused() const {
  const std::lock_guard lock(mutex_);
  return is_paused_ && !is_open_;
}

PauseGate::Clock::duration PauseGate::Pass(const std::function<bool()>& is_cancelled,
                                           const std::function<void()>& on_pause) {
  constexpr std::chrono::milliseconds kStep(100);
  std::unique_lock lock(mutex_);
  Clock::duration waited = Clock::duration::zero();
  if (!MayPass()) {
    const Clock::time_point begin = Clock::now();
    lock.unlock();
    if (on_pause) {
      on_pause();
    }
    lock.lock();
    while (!MayPass() && !is_cancelled()) {
      changed_.wait_for(lock, kStep);
    }
    waited = Clock::now() - begin;
  }
  if (steps_ > 0) {
    --steps_;
  }
  return waited;
}

}  // namespace hullslam

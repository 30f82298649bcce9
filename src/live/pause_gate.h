// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>

namespace hullslam {

// Lets one thread be paused, and go on by single steps, from other threads.
class PauseGate {
 public:
  using Clock = std::chrono::steady_clock;

  void Pause();
  void Resume();
  // Lets the thread pass once, and pauses it if it is not paused.
  void Step();
  // For good: the thread is not paused any more.
  void Open();
  bool IsPaused() const;

  // Called by the thread that can be paused, before each of its steps. Waits until it may pass, or
  // until `is_cancelled`, which is asked a few times per second, returns true. `on_pause` is called
  // before it waits. Returns how long it has waited; 0 if it was not paused.
  Clock::duration Pass(const std::function<bool()>& is_cancelled,
                       const std::function<void()>& on_pause = {});

 private:
  bool MayPass() const { return is_open_ || !is_paused_ || steps_ > 0; }

  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  bool is_paused_ = false;
  bool is_open_ = false;
  size_t steps_ = 0;
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>

namespace hullslam {

// Spreads events out in time: at most `burst` of them at once, and `per_second` in the long run.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;

  RateLimit(double per_second, double burst)
      : interval_(1.0 / per_second), burst_(burst * interval_) {}

  // Counts one event that is to happen at `now`, which must not decrease from call to call. Returns
  // how long the event has to wait.
  Clock::duration Take(Clock::time_point now) {
    const Seconds since_start = now - start_;
    next_ = std::max(next_, since_start - burst_) + interval_;
    const Seconds wait = std::max(Seconds(0.0), next_ - since_start);
    return std::chrono::duration_cast<Clock::duration>(wait);
  }

 private:
  using Seconds = std::chrono::duration<double>;

  Seconds interval_;
  Seconds burst_;
  Clock::time_point start_ = Clock::now();
  Seconds next_ = -burst_;  // when the events so far are over, at their mean rate
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <functional>

namespace hullslam {

// Asks a long computation on another thread to stop early, at its next check.
class Cancellation {
 public:
  void Request() { requested_.store(true, std::memory_order_release); }
  void Reset() { requested_.store(false, std::memory_order_release); }
  bool IsRequested() const { return requested_.load(std::memory_order_acquire); }

 private:
  std::atomic<bool> requested_{false};
};

// Whether the computation should stop. Null means that it cannot be cancelled.
inline bool IsRequested(const Cancellation* cancellation) {
  return cancellation != nullptr && cancellation->IsRequested();
}

// Called with the progress of a long computation: the number of iterations that are done, and the
// largest possible number of iterations. The computation may end earlier.
using ProgressCallback = std::function<void(int done, int most)>;

}  // namespace hullslam

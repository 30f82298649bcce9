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

// Whether there is a cancellation and it is requested. It may be null: such a computation runs to
// its end.
inline bool IsRequested(const Cancellation* cancellation) {
  return cancellation != nullptr && cancellation->IsRequested();
}

// Is told how far a long computation is: the number of iterations that are done, and the largest
// number that there may be. The computation may end before it.
using ProgressCallback = std::function<void(int done, int most)>;

}  // namespace hullslam

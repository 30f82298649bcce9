// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <mutex>
#include <utility>

namespace hullslam {

// The newest version of an immutable value: one thread publishes, any thread reads. A version stays
// alive as long as a reader holds a pointer to it.
template <typename Value>
class Published {
 public:
  void Publish(std::shared_ptr<const Value> value) {
    // The old version is released outside the lock: freeing it may take long.
    const std::lock_guard lock(mutex_);
    value_.swap(value);
  }

  // Null before the first Publish.
  std::shared_ptr<const Value> Get() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Value> value_;
};

}  // namespace hullslam

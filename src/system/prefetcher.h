// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "util/between_threads.h"

namespace hullslam {

// Runs a producer ahead of its consumer in a thread of its own, by at most `capacity` items.
template <typename Item>
class Prefetcher {
 public:
  // `produce` returns the next item, or null at the end. Only the other thread calls it.
  Prefetcher(std::function<std::optional<Item>()> produce, size_t capacity)
      : items_(capacity), thread_([this, produce = std::move(produce)] { Run(produce); }) {}

  ~Prefetcher() {
    items_.Close();
    thread_.join();
  }
  Prefetcher(const Prefetcher&) = delete;
  Prefetcher& operator=(const Prefetcher&) = delete;

  // Waits for the next item; null at the end. Rethrows what `produce` throws.
  std::optional<Item> Next() {
    std::optional<Item> item = items_.Receive();
    if (!item && failure_) {
      std::rethrow_exception(std::exchange(failure_, nullptr));
    }
    return item;
  }

 private:
  void Run(const std::function<std::optional<Item>()>& produce) {
    try {
      while (std::optional<Item> item = produce()) {
        if (!items_.Send(std::move(*item))) {
          return;
        }
      }
    } catch (...) {
      failure_ = std::current_exception();  // seen by Next once the mailbox is closed
    }
    items_.Close();
  }

  Mailbox<Item> items_;
  std::exception_ptr failure_;
  std::thread thread_;  // last member, because the thread uses the others
};

}  // namespace hullslam

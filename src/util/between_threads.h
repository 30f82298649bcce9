// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace hullslam {

// A bounded first-in first-out queue between two threads. The sender waits while the mailbox is
// full (back-pressure), and the receiver waits while it is empty. Closing the mailbox wakes both.
template <typename Message>
class Mailbox {
 public:
  explicit Mailbox(size_t capacity) : capacity_(capacity) {}

  // Returns false and drops the message if the mailbox is closed.
  bool Send(Message message) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || messages_.size() < capacity_; });
    if (closed_) {
      return false;
    }
    messages_.push_back(std::move(message));
    changed_.notify_all();
    return true;
  }

  // Returns the oldest message, or nothing if the mailbox is closed and empty.
  std::optional<Message> Receive() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || !messages_.empty(); });
    if (messages_.empty()) {
      return std::nullopt;
    }
    std::optional<Message> message(std::move(messages_.front()));
    messages_.pop_front();
    changed_.notify_all();
    return message;
  }

  // Messages that were already sent can still be received.
  void Close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  const size_t capacity_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Message> messages_;
  bool closed_ = false;
};

// The newest version of an immutable value: one thread publishes, any thread reads. A version stays
// alive as long as a reader holds a pointer to it. The publisher frees it, with a later version:
// freeing may take long, and readers must not wait for it.
template <typename Value>
class Published {
 public:
  void Publish(std::shared_ptr<const Value> value) {
    std::vector<std::shared_ptr<const Value>> unused;  // freed outside the lock
    const std::lock_guard lock(mutex_);
    former_.push_back(std::exchange(value_, std::move(value)));
    const auto begin = std::partition(former_.begin(), former_.end(),
                                      [](const auto& version) { return version.use_count() > 1; });
    unused.assign(std::move_iterator(begin), std::move_iterator(former_.end()));
    former_.erase(begin, former_.end());
  }

  // Null before the first Publish.
  std::shared_ptr<const Value> Get() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Value> value_;
  std::vector<std::shared_ptr<const Value>> former_;  // that readers held when they were replaced
};

}  // namespace hullslam

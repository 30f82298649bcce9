// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/message_hub.h"

#include <algorithm>
#include <utility>

namespace hullslam {

MessageHub::MessageHub(std::function<void()> on_message) : on_message_(std::move(on_message)) {}

void MessageHub::SetNotification(std::function<void()> on_message) {
  on_message_ = std::move(on_message);
}

MessageHub::ReaderId MessageHub::AddReader() {
  const std::lock_guard lock(mutex_);
  readers_[next_] = {};
  return next_++;
}

void MessageHub::RemoveReader(ReaderId reader) {
  const std::lock_guard lock(mutex_);
  readers_.erase(reader);
  taken_.notify_all();
}

size_t MessageHub::reader_count() const {
  const std::lock_guard lock(mutex_);
  return readers_.size();
}

bool MessageHub::NeedsWhole() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(readers_.begin(), readers_.end(),
                     [](const auto& entry) { return entry.second.NeedsWhole(); });
}

void MessageHub::GiveFrame(const SharedMessage& message) {
  {
    const std::lock_guard lock(mutex_);
    for (auto& [id, reader] : readers_) {
      if (!reader.is_behind) {
        reader.frame = message;
      }
    }
  }
  Notify();
}

void MessageHub::GiveMapChange(const SharedMessage& message) {
  {
    const std::lock_guard lock(mutex_);
    for (auto& [id, reader] : readers_) {
      if (reader.map != nullptr) {
        reader.map = nullptr;
        reader.is_behind = true;
      } else if (!reader.is_behind) {
        reader.map = message;
      }
    }
  }
  Notify();
}

void MessageHub::GiveWhole(const SharedMessage& message) {
  {
    const std::lock_guard lock(mutex_);
    for (auto& [id, reader] : readers_) {
      if (reader.NeedsWhole()) {
        reader.map = message;
        reader.is_behind = false;
      }
    }
  }
  Notify();
}

void MessageHub::LeaveBehind() {
  const std::lock_guard lock(mutex_);
  for (auto& [id, reader] : readers_) {
    reader.map = nullptr;
    reader.is_behind = true;
  }
}

SharedMessage MessageHub::Take(ReaderId reader) {
  const std::lock_guard lock(mutex_);
  const auto found = readers_.find(reader);
  if (found == readers_.end()) {
    return nullptr;
  }
  SharedMessage& place = found->second.map != nullptr ? found->second.map : found->second.frame;
  SharedMessage message = std::exchange(place, nullptr);
  found->second.is_waiting = message == nullptr;
  taken_.notify_all();
  return message;
}

bool MessageHub::WaitUntilSent(std::chrono::milliseconds longest) const {
  std::unique_lock lock(mutex_);
  return taken_.wait_for(lock, longest, [this] {
    return std::all_of(readers_.begin(), readers_.end(), [](const auto& entry) {
      const Reader& reader = entry.second;
      const bool has_all = !reader.is_behind && reader.map == nullptr && reader.frame == nullptr;
      return has_all && reader.is_waiting;
    });
  });
}

void MessageHub::Notify() const {
  if (on_message_) {
    on_message_();
  }
}

}  // namespace hullslam

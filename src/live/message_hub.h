// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace hullslam {

// A message for browsers, shared by all that it is sent to.
using SharedMessage = std::shared_ptr<const std::string>;

// Hands messages from the thread that makes them to any number of readers that take them at their
// own pace. The memory does not grow with the number of messages: each reader has two slots.
//   frame  the newest message about the current frame. A newer one replaces it.
//   map    a change of the map. If the next change comes before this one was taken, both are
//          dropped, and the reader is behind.
// A reader that is behind gets nothing until it has taken all that it was given, and then the whole
// map. A new reader is behind. All functions may be called by any thread.
class MessageHub {
 public:
  using ReaderId = uint64_t;

  // `on_message` is called when a reader has got something to take, in the thread that gave it.
  explicit MessageHub(std::function<void()> on_message = {});
  // Replaces `on_message`. No message may be given meanwhile.
  void SetNotification(std::function<void()> on_message);

  ReaderId AddReader();
  void RemoveReader(ReaderId reader);
  size_t reader_count() const;
  // Whether a reader is behind and waits.
  bool NeedsWhole() const;

  void GiveFrame(const SharedMessage& message);
  void GiveMapChange(const SharedMessage& message);
  // For the readers that are behind and wait. It includes all changes that were given before.
  void GiveWhole(const SharedMessage& message);
  // From now on all readers are behind, for example because a change would be larger than the
  // whole map.
  void LeaveBehind();

  // The next message for this reader, map before frame; null if there is none, or no such reader.
  SharedMessage Take(ReaderId reader);
  // Waits until all readers have the whole map, have taken all messages and have asked for the next
  // one, which they do when the last one was sent. Waits no longer than this.
  bool WaitUntilSent(std::chrono::milliseconds longest) const;

 private:
  struct Reader {
    SharedMessage frame;
    SharedMessage map;
    bool is_behind = true;
    bool is_waiting = true;  // it has asked for a message when there was none

    bool NeedsWhole() const { return is_behind && is_waiting; }
  };

  void Notify() const;

  mutable std::mutex mutex_;  // guards the members below
  mutable std::condition_variable taken_;
  std::map<ReaderId, Reader> readers_;
  ReaderId next_ = 0;
  std::function<void()> on_message_;  // called without the lock
};

}  // namespace hullslam

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>

#include "hullslam/util/id.h"

namespace hullslam {

// Counts for landmarks or objects how many keyframes have contradicted them since they were
// observed last. The counts do not depend on whether these keyframes are culled later.
template <typename IdType>
class Contradictions {
 public:
  // Counts one more and returns how many there are. `last_seen` is the frame of the last keyframe
  // in time that observes the landmark or object. If it is later than before, the count begins
  // again.
  int Add(IdType id, FrameId last_seen) {
    Entry& entry = entries_[id];
    if (entry.count > 0 && entry.last_seen < last_seen) {
      entry.count = 0;
    }
    entry.last_seen = last_seen;
    return ++entry.count;
  }
  // The next count begins again.
  void Forget(IdType id) { entries_.erase(id); }

 private:
  struct Entry {
    FrameId last_seen;
    int count = 0;
  };
  std::map<IdType, Entry> entries_;
};

}  // namespace hullslam

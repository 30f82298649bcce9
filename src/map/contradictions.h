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
  // Counts one more and returns how many there are. `last_observer` is the newest keyframe that
  // observes the landmark or object. If it is newer than before, the count begins again.
  int Add(IdType id, KeyframeId last_observer) {
    Entry& entry = entries_[id];
    if (entry.count > 0 && entry.last_observer < last_observer) {
      entry.count = 0;
    }
    entry.last_observer = last_observer;
    return ++entry.count;
  }
  // The next count begins again.
  void Forget(IdType id) { entries_.erase(id); }

 private:
  struct Entry {
    KeyframeId last_observer;
    int count = 0;
  };
  std::map<IdType, Entry> entries_;
};

}  // namespace hullslam

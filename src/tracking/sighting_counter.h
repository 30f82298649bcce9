// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/map/messages.h"
#include "util/id_set.h"

namespace hullslam {

// Counts, between two messages to the mapper, the frames in which each landmark should have been
// visible and the frames in which it was found.
class SightingCounter {
 public:
  void CountVisible(LandmarkId landmark) { ++counts_[landmark].visible; }
  void CountFound(LandmarkId landmark) { ++counts_[landmark].found; }

  // The counts since the last call, by increasing id. Counting starts again from zero.
  std::vector<Sighting> Take();

 private:
  struct Counts {
    int visible = 0;
    int found = 0;
  };
  IdMap<LandmarkId, Counts> counts_;
};

}  // namespace hullslam

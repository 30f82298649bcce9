// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "hullslam/map/messages.h"

namespace hullslam {

// Counts in how many frames each landmark should have been visible, and in how many it was found,
// between two messages to the mapper.
class SightingCounter {
 public:
  void CountVisible(LandmarkId landmark) { ++Slot(landmark).visible; }
  void CountFound(LandmarkId landmark) { ++Slot(landmark).found; }

  // The counts since the last call, by increasing id. Counting starts again from zero.
  std::vector<Sighting> Take();

 private:
  Sighting& Slot(LandmarkId landmark);

  static constexpr uint32_t kNone = UINT32_MAX;
  std::vector<uint32_t> index_;  // by landmark id, into sightings_
  std::vector<Sighting> sightings_;
};

}  // namespace hullslam

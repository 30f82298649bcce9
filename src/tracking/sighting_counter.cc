// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sighting_counter.h"

#include <algorithm>
#include <utility>

namespace hullslam {

std::vector<Sighting> SightingCounter::Take() {
  for (const Sighting& sighting : sightings_) {
    index_[sighting.landmark.value] = kNone;
  }
  std::vector<Sighting> taken = std::exchange(sightings_, {});
  std::sort(taken.begin(), taken.end(),
            [](const Sighting& a, const Sighting& b) { return a.landmark < b.landmark; });
  return taken;
}

Sighting& SightingCounter::Slot(LandmarkId landmark) {
  if (landmark.value >= index_.size()) {
    index_.resize(landmark.value + 1, kNone);
  }
  uint32_t& index = index_[landmark.value];
  if (index == kNone) {
    index = static_cast<uint32_t>(sightings_.size());
    sightings_.push_back({.landmark = landmark});
  }
  return sightings_[index];
}

}  // namespace hullslam

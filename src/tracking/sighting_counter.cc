// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/sighting_counter.h"

#include <algorithm>

namespace hullslam {

std::vector<Sighting> SightingCounter::Take() {
  std::vector<Sighting> sightings;
  for (const auto& [landmark, counts] : counts_.Take()) {
    sightings.push_back({landmark, counts.visible, counts.found});
  }
  std::sort(sightings.begin(), sightings.end(),
            [](const Sighting& a, const Sighting& b) { return a.landmark < b.landmark; });
  return sightings;
}

}  // namespace hullslam

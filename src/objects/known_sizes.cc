// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/known_sizes.h"

#include <optional>
#include <utility>
#include <vector>

#include "objects/object_extents.h"
#include "objects/resolved_observation.h"
#include "util/order_statistics.h"

namespace hullslam {

KnownScale MeasureScale(const Map& map, const Sensor& sensor,
                        const std::map<std::string, double>& sizes) {
  std::vector<double> scales;  // one per observation
  size_t objects = 0;
  map.objects().ForEach([&](ObjectId, const ObjectLandmark& object) {
    const bool is_mapped = object.state == ObjectState::kMapped;
    const auto size = is_mapped ? sizes.find(object.Label()) : sizes.end();
    if (size == sizes.end()) {
      return;
    }
    if (const auto extents =
            MeasureExtents(sensor, object.ellipsoid, ResolveObservations(map, object))) {
      scales.insert(scales.end(), object.observations.size(), size->second / extents->sides.z());
      ++objects;
    }
  });
  if (scales.empty()) {
    return {};
  }
  return {.objects = objects, .metres_per_unit = Median(std::move(scales))};
}

}  // namespace hullslam
